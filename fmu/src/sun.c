/* Where the sun stands, and what reaches the ground on a clear day.
 * Position: the low-precision formulas of the Astronomical Almanac (0.01 deg between 1950 and 2050).
 * Irradiance: Kasten & Young 1989 (air mass), Meinel & Meinel 1976 (direct beam); diffuse light is a tenth of the
 * beam on the horizontal. Position and time are those of home: a flight's own kilometres change nothing. */
#include <math.h>

#include "model.h"

#define SUN_PERIOD INT64_C(10000000000) /* [ns]: the sun moves 0.04 deg in it */
#define EPOCH 946728000.0               /* J2000.0, 2000-01-01 12:00 UTC, as Unix time [s] */
#define SOLAR_CONSTANT 1353.0           /* of Meinel's formula [W/m2] */
#define RADIANS (PI / 180.0)

static void irradiance(Sun *sun, double clearness) {
    sun->direct = sun->diffuse = 0.0;
    double elevation = sun->elevation / RADIANS;
    if (elevation <= 0.0) return;
    double sine = sin(sun->elevation);
    double air_mass = 1.0 / (sine + 0.50572 * pow(elevation + 6.07995, -1.6364));
    sun->direct = clearness * SOLAR_CONSTANT * pow(0.7, pow(air_mass, 0.678));
    sun->diffuse = 0.1 * sun->direct * sine;
}

void sun_sample(Model *m) {
    const Variables *v = &m->v;
    Sun *sun = &m->sun;
    m->next_sun = m->now + SUN_PERIOD;
    double days = (v->environment_start_time + (double)m->now * 1e-9 - EPOCH) / 86400.0;
    double anomaly = (357.528 + 0.9856003 * days) * RADIANS;
    double mean = 280.460 + 0.9856474 * days;
    double longitude = (mean + 1.915 * sin(anomaly) + 0.020 * sin(2.0 * anomaly)) * RADIANS;
    double obliquity = (23.439 - 0.0000004 * days) * RADIANS;
    double declination = asin(sin(obliquity) * sin(longitude));
    double ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude));
    double sidereal = fmod(280.46061837 + 360.98564736629 * days, 360.0) * RADIANS;
    double hour = sidereal + v->environment_longitude - ascension;
    double cl = cos(v->environment_latitude), sl = sin(v->environment_latitude);
    double cd = cos(declination), sd = sin(declination);
    double up = sl * sd + cl * cd * cos(hour);
    sun->direction[0] = cl * sd - sl * cd * cos(hour);
    sun->direction[1] = -cd * sin(hour);
    sun->direction[2] = -up;
    sun->elevation = asin(clamp(up, -1.0, 1.0));
    sun->azimuth = atan2(sun->direction[1], sun->direction[0]);
    irradiance(sun, v->environment_clearness);
}
