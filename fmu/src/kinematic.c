/* The same aircraft as a coordinated turn with roll lag (paper, Eqs. 13-14), for thousands of fast runs:
 *   heading rate = f g tan(bank) / V, bank a first-order lag with a rate limit,
 *   climb and airspeed first-order lags; f is the airframe's turn factor. */
#include <math.h>

#include "model.h"

static void derivative(const Model *m, const double x[], double dx[]) {
    const Variables *v = &m->v;
    double airspeed = x[K_AIRSPEED] > 1.0 ? x[K_AIRSPEED] : 1.0;
    double rise = x[K_CLIMB] + v->wind_down; /* through the air */
    double level2 = airspeed * airspeed - rise * rise;
    double level = level2 > 0.0 ? sqrt(level2) : 0.0;
    dx[K_NORTH] = level * cos(x[K_HEADING]) + v->wind_north;
    dx[K_EAST] = level * sin(x[K_HEADING]) + v->wind_east;
    dx[K_ALTITUDE] = x[K_CLIMB];
    dx[K_AIRSPEED] = clamp((m->demand.airspeed - x[K_AIRSPEED]) / v->aircraft_kinematic_airspeed_time,
                           -v->aircraft_control_acceleration_limit, v->aircraft_control_acceleration_limit);
    dx[K_HEADING] = v->aircraft_kinematic_turn_factor * v->environment_gravity * tan(x[K_BANK]) / airspeed;
    dx[K_BANK] = clamp((m->demand.bank - x[K_BANK]) / v->aircraft_kinematic_roll_time,
                       -v->aircraft_control_roll_rate_limit, v->aircraft_control_roll_rate_limit);
    dx[K_CLIMB] = (m->demand.climb - x[K_CLIMB]) / v->aircraft_kinematic_climb_time;
}

/* One Runge-Kutta step of order four. */
void kinematic_advance(Model *m, double h) {
    double k[N_KINEMATIC], sum[N_KINEMATIC], at[N_KINEMATIC];
    double *x = m->x;
    derivative(m, x, k);
    for (int i = 0; i < N_KINEMATIC; i++) { sum[i] = k[i]; at[i] = x[i] + 0.5 * h * k[i]; }
    derivative(m, at, k);
    for (int i = 0; i < N_KINEMATIC; i++) { sum[i] += 2.0 * k[i]; at[i] = x[i] + 0.5 * h * k[i]; }
    derivative(m, at, k);
    for (int i = 0; i < N_KINEMATIC; i++) { sum[i] += 2.0 * k[i]; at[i] = x[i] + h * k[i]; }
    derivative(m, at, k);
    for (int i = 0; i < N_KINEMATIC; i++) x[i] += h / 6.0 * (sum[i] + k[i]);
    x[K_HEADING] = wrap(x[K_HEADING]);
}

void kinematic_motion(const Model *m, Motion *o) {
    const double *x = m->x;
    double dx[N_KINEMATIC];
    derivative(m, x, dx);
    double airspeed = x[K_AIRSPEED] > 1.0 ? x[K_AIRSPEED] : 1.0;
    o->north = x[K_NORTH];
    o->east = x[K_EAST];
    o->altitude = x[K_ALTITUDE];
    o->velocity_north = dx[K_NORTH];
    o->velocity_east = dx[K_EAST];
    o->climb = x[K_CLIMB];
    o->airspeed = airspeed;
    o->alpha = m->trim.alpha;
    o->beta = 0.0;
    o->bank = x[K_BANK];
    o->pitch = asin(clamp((x[K_CLIMB] + m->v.wind_down) / airspeed, -1.0, 1.0)) + o->alpha * cos(x[K_BANK]);
    o->heading = wrap(x[K_HEADING]);
    o->p = dx[K_BANK];
    o->q = dx[K_HEADING] * sin(x[K_BANK]);
    o->r = dx[K_HEADING] * cos(x[K_BANK]);
}
