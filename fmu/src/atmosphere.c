/* US Standard Atmosphere 1976 (NASA-TM-X-74335), geopotential layers up to 20 km. */
#include <math.h>

#include "model.h"

#define EARTH_RADIUS 6356766.0
#define SEA_LEVEL_DENSITY 1.225
#define SEA_LEVEL_TEMPERATURE 288.15
#define LAPSE_RATE 0.0065
#define HYDROSTATIC_EXPONENT 5.25587611 /* g0 M / (R L) */
#define TROPOPAUSE 11000.0
#define SCALE_HEIGHT 6341.6204 /* R T / (g0 M) at 216.65 K [m] */

/* Density [kg/m3] at a geometric altitude above mean sea level [m]. */
double air_density(double altitude) {
    double h = EARTH_RADIUS * altitude / (EARTH_RADIUS + altitude);
    double troposphere = h < TROPOPAUSE ? h : TROPOPAUSE;
    double ratio = 1.0 - LAPSE_RATE * troposphere / SEA_LEVEL_TEMPERATURE;
    double density = SEA_LEVEL_DENSITY * pow(ratio, HYDROSTATIC_EXPONENT - 1.0);
    return h < TROPOPAUSE ? density : density * exp((TROPOPAUSE - h) / SCALE_HEIGHT);
}
