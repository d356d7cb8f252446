/* US Standard Atmosphere 1976 (NASA-TM-X-74335), geopotential layers up to 20 km. */
#include <math.h>

#include "model.h"

#define EARTH_RADIUS 6356766.0
#define SEA_LEVEL_DENSITY 1.225
#define SEA_LEVEL_TEMPERATURE 288.15
#define LAPSE_RATE 0.0065
#define HYDROSTATIC_EXPONENT 5.25587611 /* g0 M / (R L) */
#define GAS_CONSTANT 287.05287          /* [J/(kg K)] */
#define NEAR 0.5 /* linear in altitude holds to 2e-9 within [m] */
#define TROPOPAUSE 11000.0
#define SCALE_HEIGHT 6341.6204 /* R T / (g0 M) at 216.65 K [m] */

/* The air at a geometric altitude above mean sea level [m]. */
Air air_at(double altitude) {
    double shrink = EARTH_RADIUS / (EARTH_RADIUS + altitude), h = shrink * altitude;
    double troposphere = h < TROPOPAUSE ? h : TROPOPAUSE;
    double ratio = 1.0 - LAPSE_RATE * troposphere / SEA_LEVEL_TEMPERATURE;
    double density = SEA_LEVEL_DENSITY * pow(ratio, HYDROSTATIC_EXPONENT - 1.0);
    if (h >= TROPOPAUSE) density *= exp((TROPOPAUSE - h) / SCALE_HEIGHT);
    Air air = {.density = density, .temperature = SEA_LEVEL_TEMPERATURE * ratio};
    air.pressure = density * GAS_CONSTANT * air.temperature;
    double fall = h < TROPOPAUSE ? (HYDROSTATIC_EXPONENT - 1.0) * LAPSE_RATE / air.temperature : 1.0 / SCALE_HEIGHT;
    air.slope = -density * fall * shrink * shrink;
    return air;
}

/* Taken anew once the aircraft is elsewhere; at once if density is zero, as it is before the start. */
void atmosphere_sample(Model *m) {
    double altitude = m->x[X_ALTITUDE];
    m->gravity = gravity_at(&m->v, altitude);
    if (fabs(altitude - m->air_altitude) < NEAR && m->air.density > 0.0) return;
    m->air_altitude = altitude;
    m->air = air_at(m->v.environment_home_elevation + m->air_altitude);
}
