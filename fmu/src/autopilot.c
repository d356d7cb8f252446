/* Demands of the guidance to surfaces and throttle: what the model says the demand needs, plus feedback.
 *
 * Differs from the paper: Eq. 18 (aileron = -20 x bank error) saturates at one degree of error and presumes
 * the opposite sign of the aileron (E21); here bank error asks for a roll rate, and aileron makes it. */
#include <math.h>
#include <string.h>

#include "model.h"

#define ROLL_INTEGRAL_BAND 0.1   /* integrate only near the commanded bank [rad] */
#define CLIMB_INTEGRAL_BAND 0.03 /* integrate only near the commanded path [rad] */
#define SPEED_INTEGRAL_BAND 0.5  /* integrate only near the commanded airspeed [m/s] */
#define STEEPEST_BANK 0.36235775447667357 /* cosine of 1.2 rad: load factor is reckoned no further */

/* Sine of an angle of attack: its series, to 2e-7 within 0.4 rad. */
static inline double sine(double a) {
    double a2 = a * a;
    return RARELY(a2 >= 0.16) ? sin(a) : a * (1.0 - a2 * (1.0 / 6.0 - a2 * (1.0 / 120.0)));
}

/* Integrals zero, and the feed-forward where level flight has it. */
void autopilot_reset(Model *m) {
    memset(&m->autopilot, 0, sizeof m->autopilot);
    m->autopilot.alpha = m->trim.alpha;
    m->autopilot.sin_alpha = sine(m->trim.alpha);
    m->autopilot.thrust = m->trim.thrust;
}

static inline double aileron(Model *m, const Motion *o, double per_airspeed, double period) {
    const Variables *v = &m->v;
    double error = m->demand.bank - o->bank;
    double limit = v->aircraft_control_roll_rate_limit;
    double rate = clamp(error / v->aircraft_control_roll_time, -limit, limit);
    double per_rate = -v->aircraft_aero_Cl_p * v->aircraft_wing_span * 0.5 * per_airspeed / v->aircraft_aero_Cl_aileron;
    double *integral = &m->autopilot.roll;
    if (fabs(error) < ROLL_INTEGRAL_BAND)
        *integral = clamp(*integral + period * v->aircraft_control_roll_integral_gain * error, -0.2, 0.2);
    return per_rate * rate + v->aircraft_control_roll_rate_gain * (rate - o->p) + *integral;
}

/* Coordinates the turn and damps yaw; nothing where there is no rudder. */
static inline double rudder(Model *m, const Motion *o, double airspeed, double period) {
    const Variables *v = &m->v;
    double limit = v->aircraft_actuator_rudder_limit;
    if (limit <= 0.0) return 0.0;
    double turn = m->gravity * o->sin_bank * cos(o->pitch) / airspeed;
    double *integral = &m->autopilot.sideslip;
    *integral = clamp(*integral + period * v->aircraft_control_sideslip_integral_gain * o->beta, -limit, limit);
    return v->aircraft_control_yaw_rate_gain * (turn - o->r) + v->aircraft_control_sideslip_gain * o->beta + *integral;
}

/* Climb demand to elevator. The angle of attack that carries the weight in this turn follows from the lift
 * polynomial by one Newton step per sample; pitch = path + alpha cos(bank) + beta sin(bank). */
static inline double elevator(Model *m, const Motion *o, double per_airspeed, double pressure_area, double rise,
                              double period) {
    const Variables *v = &m->v;
    AutopilotMemory *a = &m->autopilot;
    double cb = o->cos_bank > STEEPEST_BANK ? o->cos_bank : STEEPEST_BANK;
    double most = sqrt(1.0 - cb * cb), sb = clamp(o->sin_bank, -most, most);
    double level = sqrt(1.0 - rise * rise); /* cosine of the path */
    double per_pressure = 1.0 / pressure_area;
    double turn_pitch_rate = m->gravity * per_airspeed * sb * sb / cb;
    double q = turn_pitch_rate * v->aircraft_wing_chord * 0.5 * per_airspeed;
    double moment = v->aircraft_aero_Cm0 + v->aircraft_aero_Cm_alpha * a->alpha + v->aircraft_aero_Cm_q * q;
    double needed = -moment / v->aircraft_aero_Cm_elevator, slope;
    double carried = lift_coefficient(v, a->alpha, &slope) + v->aircraft_aero_CL_q * q
        + v->aircraft_aero_CL_elevator * needed + a->thrust * a->sin_alpha * per_pressure;
    double weight = v->aircraft_mass * m->gravity * level / cb;
    if (slope > 0.1) a->alpha += (weight * per_pressure - carried) / slope;
    a->alpha = clamp(a->alpha, v->aircraft_aero_alpha_min, v->aircraft_aero_alpha_max);
    a->sin_alpha = sine(a->alpha);

    double path = angle_of_sine(rise), error = (rise - clamp(o->climb * per_airspeed, -0.9, 0.9)) / level;
    if (fabs(error) < CLIMB_INTEGRAL_BAND)
        a->climb = clamp(a->climb + period * v->aircraft_control_climb_integral_gain * error, -0.1, 0.1);
    double pitch = path + a->alpha * cb + o->beta * sb + v->aircraft_control_climb_gain * error + a->climb;
    double rate = o->q - turn_pitch_rate;
    return needed - v->aircraft_control_pitch_gain * (pitch - o->pitch) + v->aircraft_control_pitch_rate_gain * rate;
}

static inline double throttle(Model *m, const Motion *o, double pressure_area, double rise, double de, double period) {
    const Variables *v = &m->v;
    AutopilotMemory *a = &m->autopilot;
    double error = m->demand.airspeed - o->airspeed, limit = v->aircraft_control_acceleration_limit;
    double cosine = sqrt(clamp(1.0 - a->sin_alpha * a->sin_alpha, 0.01, 1.0));
    double drag = pressure_area * drag_coefficient(v, a->alpha, o->beta, de) / cosine;
    double ahead = m->gravity * rise + clamp(error / v->aircraft_control_airspeed_time, -limit, limit);
    a->thrust = drag + v->aircraft_mass * (ahead + a->airspeed);
    double setting = throttle_for(v, a->thrust, o->airspeed, m->air.density);
    bool pushing = (setting >= 1.0 && error > 0.0) || (setting <= 0.0 && error < 0.0);
    if (!pushing && fabs(error) < SPEED_INTEGRAL_BAND)
        a->airspeed = clamp(a->airspeed + period * v->aircraft_control_airspeed_integral_gain * error, -1.0, 1.0);
    return setting;
}

void autopilot_sample(Model *m, const Motion *o, double period) {
    const Variables *v = &m->v;
    double slowest = 0.5 * v->aircraft_limits_min_airspeed;
    double airspeed = o->airspeed > slowest ? o->airspeed : slowest;
    double pressure_area = 0.5 * m->air.density * airspeed * airspeed * v->aircraft_wing_area;
    double per_airspeed = 1.0 / airspeed, rise = clamp(m->demand.climb * per_airspeed, -0.5, 0.5);
    m->actuator[0] = aileron(m, o, per_airspeed, period);
    m->actuator[3] = throttle(m, o, pressure_area, rise, m->x[X_ELEVATOR], period); /* with the last angle of attack */
    m->actuator[1] = elevator(m, o, per_airspeed, pressure_area, rise, period);
    m->actuator[2] = rudder(m, o, airspeed, period);
}
