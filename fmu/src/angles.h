/* Angles from sines and tangents.
 *
 * Angles of attack, of sideslip and of the path are small nearly always: there their power series, to the last bit
 * or two of the mathematics library's answer, in a third of its time and the same from every compiler; beyond, the
 * library. Sums in pairs do not wait for one another. */
#ifndef SIDESTEP_ANGLES_H
#define SIDESTEP_ANGLES_H

#include <math.h>

/* Tells the compiler which branch is cold, so that what lives in registers is saved there and not before: no register
 * for numbers outlives a call. */
#if defined(__GNUC__)
#define RARELY(condition) __builtin_expect(!!(condition), 0)
#else
#define RARELY(condition) (condition)
#endif

#define SMALL 0.125 /* the first term left out is below 1e-18 of the angle */

/* Arc tangent of y/x in the right quadrant. */
static inline double angle_of(double y, double x) {
    if (RARELY(!(x > 0.0 && fabs(y) < SMALL * x))) return atan2(y, x);
    double t = y / x, z = t * t, z2 = z * z, z4 = z2 * z2;
    double low = (-1.0 / 3.0 + z * (1.0 / 5.0)) + z2 * (-1.0 / 7.0 + z * (1.0 / 9.0));
    double high = (-1.0 / 11.0 + z * (1.0 / 13.0)) + z2 * (-1.0 / 15.0 + z * (1.0 / 17.0));
    return t + t * z * (low + z4 * high);
}

/* Arc sine; beyond one that of one. */
static inline double angle_of_sine(double s) {
    if (RARELY(!(fabs(s) < SMALL))) return asin(s > 1.0 ? 1.0 : s < -1.0 ? -1.0 : s);
    double z = s * s, z2 = z * z, z4 = z2 * z2;
    double low = (1.0 / 6.0 + z * (3.0 / 40.0)) + z2 * (5.0 / 112.0 + z * (35.0 / 1152.0));
    double high = (63.0 / 2816.0 + z * (231.0 / 13312.0)) + z2 * (143.0 / 10240.0 + z * (6435.0 / 557056.0));
    return s + s * z * (low + z4 * high);
}

#endif
