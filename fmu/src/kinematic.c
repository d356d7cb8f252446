/* The same aircraft as a coordinated turn with roll lag (paper, Eqs. 13-14), for thousands of fast runs:
 *   heading rate = f g tan(bank) / V, bank a first-order lag with a rate limit,
 *   climb and airspeed first-order lags; f is the airframe's turn factor. */
#include <math.h>
#include <string.h>

#include "model.h"

static void derivative(const Model *m, const double x[], double dx[]) {
    const Variables *v = &m->v;
    if (m->flight != FLIGHT_FLYING) {
        memset(dx, 0, N_KINEMATIC * sizeof(double));
        return;
    }
    const double *gust = m->turbulence.gust;
    double airspeed = x[K_AIRSPEED] > 1.0 ? x[K_AIRSPEED] : 1.0;
    double rise = x[K_CLIMB] + v->wind_down + gust[2]; /* through the air */
    double level2 = airspeed * airspeed - rise * rise;
    double level = level2 > 0.0 ? sqrt(level2) : 0.0;
    dx[K_NORTH] = level * cos(x[K_HEADING]) + v->wind_north + gust[0];
    dx[K_EAST] = level * sin(x[K_HEADING]) + v->wind_east + gust[1];
    dx[K_ALTITUDE] = x[K_CLIMB];
    dx[K_AIRSPEED] = clamp((m->demand.airspeed - x[K_AIRSPEED]) / v->aircraft_kinematic_airspeed_time,
                           -v->aircraft_control_acceleration_limit, v->aircraft_control_acceleration_limit);
    dx[K_HEADING] = v->aircraft_kinematic_turn_factor * gravity_at(v, x[K_ALTITUDE]) * tan(x[K_BANK]) / airspeed;
    dx[K_BANK] = clamp((m->demand.bank - x[K_BANK]) / v->aircraft_kinematic_roll_time,
                       -v->aircraft_control_roll_rate_limit, v->aircraft_control_roll_rate_limit);
    dx[K_CLIMB] = (m->demand.climb - x[K_CLIMB]) / v->aircraft_kinematic_climb_time;
}

/* Thrust times airspeed [W] that this flight needs: the drag of the 6-DOF aircraft at this load, and the climb. */
static double shaft_power(const Model *m) {
    const Variables *v = &m->v;
    double airspeed = m->x[K_AIRSPEED] > 1.0 ? m->x[K_AIRSPEED] : 1.0;
    if (m->flight != FLIGHT_FLYING || m->empty) return 0.0;
    double weight = v->aircraft_mass * gravity_at(v, m->x[K_ALTITUDE]), slope;
    double pressure_area = 0.5 * m->air.density * airspeed * airspeed * v->aircraft_wing_area;
    double level = lift_coefficient(v, m->trim.alpha, &slope);
    double wanted = weight / (cos(m->x[K_BANK]) * pressure_area);
    double alpha = slope > 0.1 ? m->trim.alpha + (wanted - level) / slope : m->trim.alpha;
    double drag = pressure_area * drag_coefficient(v, alpha, 0.0, m->trim.elevator);
    return drag * airspeed + weight * m->x[K_CLIMB];
}

/* One Runge-Kutta step of order four. */
void kinematic_advance(Model *m, double h) {
    double k[N_KINEMATIC], sum[N_KINEMATIC], at[N_KINEMATIC];
    double *x = m->x;
    double up = cos(x[K_BANK]), right = sin(x[K_BANK]), ahead = x[K_HEADING];
    const double *sun = m->sun.direction;
    double sunlight = -sun[2] * up + right * (-sun[0] * sin(ahead) + sun[1] * cos(ahead));
    m->power = power_balance(m, x[X_ENERGY], shaft_power(m), sunlight);
    derivative(m, x, k);
    for (int i = 0; i < N_KINEMATIC; i++) { sum[i] = k[i]; at[i] = x[i] + 0.5 * h * k[i]; }
    derivative(m, at, k);
    for (int i = 0; i < N_KINEMATIC; i++) { sum[i] += 2.0 * k[i]; at[i] = x[i] + 0.5 * h * k[i]; }
    derivative(m, at, k);
    for (int i = 0; i < N_KINEMATIC; i++) { sum[i] += 2.0 * k[i]; at[i] = x[i] + h * k[i]; }
    derivative(m, at, k);
    for (int i = 0; i < N_KINEMATIC; i++) x[i] += h / 6.0 * (sum[i] + k[i]);
    x[K_HEADING] = wrap(x[K_HEADING]);
    battery_advance(m, &m->power, h);
}

void kinematic_motion(const Model *m, Motion *o) {
    const double *x = m->x;
    double dx[N_KINEMATIC];
    derivative(m, x, dx);
    bool flying = m->flight == FLIGHT_FLYING;
    double airspeed = x[K_AIRSPEED] > 1.0 || !flying ? x[K_AIRSPEED] : 1.0;
    double rise = (x[K_CLIMB] + m->v.wind_down) / (airspeed > 1.0 ? airspeed : 1.0);
    o->north = x[K_NORTH];
    o->east = x[K_EAST];
    o->altitude = x[K_ALTITUDE];
    o->velocity_north = dx[K_NORTH];
    o->velocity_east = dx[K_EAST];
    o->climb = x[K_CLIMB];
    o->airspeed = airspeed;
    o->alpha = flying ? m->trim.alpha : 0.0;
    o->beta = 0.0;
    o->bank = x[K_BANK];
    o->sin_bank = sin(x[K_BANK]);
    o->cos_bank = cos(x[K_BANK]);
    o->pitch = flying ? asin(clamp(rise, -1.0, 1.0)) + o->alpha * cos(x[K_BANK]) : 0.0;
    o->heading = wrap(x[K_HEADING]);
    o->p = dx[K_BANK];
    o->q = dx[K_HEADING] * sin(x[K_BANK]);
    o->r = dx[K_HEADING] * cos(x[K_BANK]);
}
