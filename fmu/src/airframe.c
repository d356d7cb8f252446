/* Six degrees of freedom: flat earth, rigid body, quaternion attitude (Beard & McLain 2012, ch. 3-4;
 * Stevens & Lewis 2003, 1.5 and 1.7), actuators as first-order lags with rate and position limits. */
#include <math.h>

#include "model.h"

#define SLOWEST 1e-3 /* below this airspeed [m/s] the air does nothing */

void inertia_constants(const Variables *v, InertiaConstants *k) {
    double xx = v->aircraft_inertia_xx, yy = v->aircraft_inertia_yy;
    double zz = v->aircraft_inertia_zz, xz = v->aircraft_inertia_xz;
    double det = xx * zz - xz * xz;
    k->c1 = ((yy - zz) * zz - xz * xz) / det;
    k->c2 = (xx - yy + zz) * xz / det;
    k->c3 = zz / det;
    k->c4 = xz / det;
    k->c5 = (zz - xx) / yy;
    k->c6 = xz / yy;
    k->c7 = 1.0 / yy;
    k->c8 = (xx * (xx - yy) + xz * xz) / det;
    k->c9 = xx / det;
}

/* Whether a rigid body can have this tensor: principal moments positive, none above the sum of the others. */
bool inertia_is_real(const Variables *v) {
    double xx = v->aircraft_inertia_xx, yy = v->aircraft_inertia_yy;
    double zz = v->aircraft_inertia_zz, xz = v->aircraft_inertia_xz;
    double mean = 0.5 * (xx + zz), half = sqrt(0.25 * (xx - zz) * (xx - zz) + xz * xz);
    double small = mean - half, large = mean + half;
    return small > 0.0 && large <= small + yy && yy <= small + large;
}

/* Lift coefficient without rates and elevator; held beyond the limits of the data. */
double lift_coefficient(const Variables *v, double alpha, double *slope) {
    double a = clamp(alpha, v->aircraft_aero_alpha_min, v->aircraft_aero_alpha_max);
    double a1 = v->aircraft_aero_CL_alpha, a2 = v->aircraft_aero_CL_alpha2, a3 = v->aircraft_aero_CL_alpha3;
    if (slope) *slope = a1 + a * (2.0 * a2 + 3.0 * a3 * a);
    return v->aircraft_aero_CL0 + a * (a1 + a * (a2 + a * a3));
}

/* Drag coefficient. Beyond the limits of the data the drag of a flat plate is added: 2 sin2(alpha). */
double drag_coefficient(const Variables *v, double alpha, double beta, double elevator) {
    double a = clamp(alpha, v->aircraft_aero_alpha_min, v->aircraft_aero_alpha_max);
    double plate = 0.0;
    if (RARELY(a != alpha)) {
        double s = sin(alpha), s0 = sin(a);
        plate = s * s > s0 * s0 ? 2.0 * (s * s - s0 * s0) : 0.0; /* never a push, also flying backwards */
    }
    return v->aircraft_aero_CD0 + a * (v->aircraft_aero_CD_alpha + a * v->aircraft_aero_CD_alpha2) + plate
        + v->aircraft_aero_CD_elevator2 * elevator * elevator
        + beta * (v->aircraft_aero_CD_beta + beta * v->aircraft_aero_CD_beta2);
}

/* Gravity falls with height above mean sea level, linearly. */
double gravity_at(const Variables *v, double altitude) {
    return v->environment_gravity - v->environment_gravity_gradient * (v->environment_home_elevation + altitude);
}

static inline void wind_in_body(const Model *m, const double R[9], double wind[3]) {
    const double *gust = m->turbulence.gust;
    double ned[3] = {m->v.wind_north + gust[0], m->v.wind_east + gust[1], m->v.wind_down + gust[2]};
    if (ned[0] == 0.0 && ned[1] == 0.0 && ned[2] == 0.0) wind[0] = wind[1] = wind[2] = 0.0;
    else rotate_back(R, ned, wind);
}

/* Forces and moments of air and engine on the body. */
static inline void airframe_loads(const Model *m, const double x[], const double R[9], Loads *loads) {
    const Variables *v = &m->v;
    double wind[3], density = density_at(m, x[X_ALTITUDE]);
    wind_in_body(m, R, wind);
    double u = x[X_U] - wind[0], side = x[X_V] - wind[1], w = x[X_W] - wind[2];
    double airspeed = sqrt(u * u + side * side + w * w);
    *loads = (Loads){.airspeed = airspeed};
    loads->thrust = thrust(v, x[X_THROTTLE], airspeed, density);
    loads->force[0] = loads->thrust;
    if (airspeed < SLOWEST) return;

    double per_airspeed = 1.0 / airspeed;
    double alpha = angle_of(w, u), beta = angle_of_sine(side * per_airspeed);
    loads->alpha = alpha;
    loads->beta = beta;
    loads->stalled = alpha < v->aircraft_aero_alpha_min || alpha > v->aircraft_aero_alpha_max;

    double span = v->aircraft_wing_span, chord = v->aircraft_wing_chord;
    double half_span = 0.5 * span * per_airspeed, half_chord = 0.5 * chord * per_airspeed;
    double p = x[X_P] * half_span, r = x[X_R] * half_span, q = x[X_Q] * half_chord; /* nondimensional */
    double da = x[X_AILERON], de = x[X_ELEVATOR], dr = x[X_RUDDER];
    double CL = lift_coefficient(v, alpha, 0) + v->aircraft_aero_CL_q * q + v->aircraft_aero_CL_elevator * de;
    double CD = drag_coefficient(v, alpha, beta, de);
    double CY = v->aircraft_aero_CY_beta * beta + v->aircraft_aero_CY_p * p + v->aircraft_aero_CY_r * r
        + v->aircraft_aero_CY_aileron * da + v->aircraft_aero_CY_rudder * dr;
    double Cl = v->aircraft_aero_Cl_beta * beta + v->aircraft_aero_Cl_p * p + v->aircraft_aero_Cl_r * r
        + v->aircraft_aero_Cl_aileron * da + v->aircraft_aero_Cl_rudder * dr;
    double Cm = v->aircraft_aero_Cm0 + v->aircraft_aero_Cm_alpha * alpha + v->aircraft_aero_Cm_q * q
        + v->aircraft_aero_Cm_elevator * de;
    double Cn = v->aircraft_aero_Cn_beta * beta + v->aircraft_aero_Cn_p * p + v->aircraft_aero_Cn_r * r
        + v->aircraft_aero_Cn_aileron * da + v->aircraft_aero_Cn_rudder * dr;

    double pressure_area = 0.5 * density * airspeed * airspeed * v->aircraft_wing_area;
    double in_plane = sqrt(u * u + w * w);
    double per_plane = in_plane > 0.0 ? 1.0 / in_plane : 0.0, ca = u * per_plane, sa = w * per_plane;
    loads->force[0] += pressure_area * (CL * sa - CD * ca);
    loads->force[1] = pressure_area * CY;
    loads->force[2] = pressure_area * (-CL * ca - CD * sa);
    loads->moment[0] = pressure_area * span * Cl;
    loads->moment[1] = pressure_area * chord * Cm;
    loads->moment[2] = pressure_area * span * Cn;
}

static inline double lag(double command, double position, double low, double high, double per_time, double rate) {
    return clamp((clamp(command, low, high) - position) * per_time, -rate, rate);
}

/* Actuators. Elevons: the limits are those of each elevon, aileron and elevator their difference and mean
 * (left = elevator + aileron, right = elevator - aileron, trailing edge down positive). */
static inline void actuator_rates(const Model *m, const double x[], double dx[]) {
    const Variables *v = &m->v;
    double per_time = m->per_surface_time, rate = v->aircraft_actuator_surface_rate;
    double a = v->aircraft_actuator_aileron_limit, el = v->aircraft_actuator_elevator_limit;
    double ru = v->aircraft_actuator_rudder_limit;
    const double *command = m->actuator;
    if (v->aircraft_actuator_elevons != 0.0) {
        double left = lag(command[1] + command[0], x[X_ELEVATOR] + x[X_AILERON], -a, a, per_time, rate);
        double right = lag(command[1] - command[0], x[X_ELEVATOR] - x[X_AILERON], -a, a, per_time, rate);
        dx[X_AILERON] = 0.5 * (left - right);
        dx[X_ELEVATOR] = 0.5 * (left + right);
    } else {
        dx[X_AILERON] = lag(command[0], x[X_AILERON], -a, a, per_time, rate);
        dx[X_ELEVATOR] = lag(command[1], x[X_ELEVATOR], -el, el, per_time, rate);
    }
    dx[X_RUDDER] = lag(command[2], x[X_RUDDER], -ru, ru, per_time, rate);
    dx[X_THROTTLE] = lag(m->empty ? 0.0 : command[3], x[X_THROTTLE], 0.0, 1.0,
                         m->per_throttle_time, v->aircraft_actuator_throttle_rate);
}

/* Earth rotation and the curvature of its surface (Stevens & Lewis 1.5; Groves 2013, 5.4): the velocity over
 * ground feels twice the earth's rate and the transport rate v/R, the attitude turns against both. */
static void earth_turns(const Model *m, const double x[], const double R[9], const double ned[3], double *dx) {
    const Variables *v = &m->v;
    double rate = v->environment_earth_rate, per_radius = v->environment_earth_curvature;
    double latitude = v->environment_latitude + x[X_NORTH] * per_radius;
    double cl = cos(latitude), sl = sin(latitude);
    double earth[3] = {rate * cl, 0.0, -rate * sl}, turn[3], spin[3];
    double frame[3] = {earth[0] + ned[1] * per_radius, -ned[0] * per_radius,
                       earth[2] - ned[1] * per_radius * (fabs(cl) > 1e-6 ? sl / cl : 0.0)};
    rotate_back(R, earth, turn);
    rotate_back(R, frame, spin);
    dx[X_U] -= turn[1] * x[X_W] - turn[2] * x[X_V];
    dx[X_V] -= turn[2] * x[X_U] - turn[0] * x[X_W];
    dx[X_W] -= turn[0] * x[X_V] - turn[1] * x[X_U];
    const double *e = x + X_Q0;
    dx[X_Q0] -= 0.5 * (-e[1] * spin[0] - e[2] * spin[1] - e[3] * spin[2]);
    dx[X_Q1] -= 0.5 * (e[0] * spin[0] + e[2] * spin[2] - e[3] * spin[1]);
    dx[X_Q2] -= 0.5 * (e[0] * spin[1] - e[1] * spin[2] + e[3] * spin[0]);
    dx[X_Q3] -= 0.5 * (e[0] * spin[2] + e[1] * spin[1] - e[2] * spin[0]);
}

/* Where an importer integrates, nobody brings the quaternion back to unit length: draw it there. */
static void keep_unit_length(const double x[], double dx[]) {
    const double *e = x + X_Q0;
    double excess = e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3] - 1.0;
    for (int i = 0; i < 4; i++) dx[X_Q0 + i] -= 5.0 * clamp(excess, -1.0, 1.0) * e[i];
}

void airframe_derivative(const Model *m, const double x[], double dx[], Loads *loads) {
    const Variables *v = &m->v;
    double R[9], ned[3];
    rotation_matrix(x + X_Q0, R);
    airframe_loads(m, x, R, loads);
    loads->sunlight = -(R[2] * m->sun.direction[0] + R[5] * m->sun.direction[1] + R[8] * m->sun.direction[2]);
    actuator_rates(m, x, dx);
    rotate(R, x + X_U, ned);
    dx[X_NORTH] = ned[0];
    dx[X_EAST] = ned[1];
    dx[X_ALTITUDE] = -ned[2];
    if (RARELY(m->flight != FLIGHT_FLYING)) {
        ground_motion(m, x, R, loads, dx);
        return;
    }

    double gravity = gravity_at(v, x[X_ALTITUDE]);
    double p = x[X_P], q = x[X_Q], r = x[X_R];
    double per_mass = m->per_mass;
    dx[X_U] = r * x[X_V] - q * x[X_W] + gravity * R[6] + loads->force[0] * per_mass;
    dx[X_V] = p * x[X_W] - r * x[X_U] + gravity * R[7] + loads->force[1] * per_mass;
    dx[X_W] = q * x[X_U] - p * x[X_V] + gravity * R[8] + loads->force[2] * per_mass;

    const double *e = x + X_Q0;
    dx[X_Q0] = 0.5 * (-e[1] * p - e[2] * q - e[3] * r);
    dx[X_Q1] = 0.5 * (e[0] * p + e[2] * r - e[3] * q);
    dx[X_Q2] = 0.5 * (e[0] * q - e[1] * r + e[3] * p);
    dx[X_Q3] = 0.5 * (e[0] * r + e[1] * q - e[2] * p);

    const InertiaConstants *k = &m->inertia;
    const double *moment = loads->moment;
    dx[X_P] = (k->c1 * r + k->c2 * p) * q + k->c3 * moment[0] + k->c4 * moment[2];
    dx[X_Q] = k->c5 * p * r - k->c6 * (p * p - r * r) + k->c7 * moment[1];
    dx[X_R] = (k->c8 * p - k->c2 * r) * q + k->c4 * moment[0] + k->c9 * moment[2];

    if (RARELY(v->environment_earth_rate != 0.0 || v->environment_earth_curvature != 0.0))
        earth_turns(m, x, R, ned, dx);
    if (RARELY(m->continuous)) keep_unit_length(x, dx);
}

/* One Runge-Kutta step of order four; the quaternion is brought back to unit length. */
void airframe_advance(Model *m, double h) {
    double k[N_STATES], sum[N_MECHANICAL], at[N_STATES];
    Loads loads;
    double *x = m->x;
    airframe_derivative(m, x, k, &loads);
    if (m->now >= m->next_power) {
        m->power = power_balance(m, x[X_ENERGY], loads.thrust * loads.airspeed, loads.sunlight);
        m->next_power = (m->now / POWER_PERIOD + 1) * POWER_PERIOD;
    }
    for (int i = 0; i < N_MECHANICAL; i++) { sum[i] = k[i]; at[i] = x[i] + 0.5 * h * k[i]; }
    airframe_derivative(m, at, k, &loads);
    for (int i = 0; i < N_MECHANICAL; i++) { sum[i] += 2.0 * k[i]; at[i] = x[i] + 0.5 * h * k[i]; }
    airframe_derivative(m, at, k, &loads);
    for (int i = 0; i < N_MECHANICAL; i++) { sum[i] += 2.0 * k[i]; at[i] = x[i] + h * k[i]; }
    airframe_derivative(m, at, k, &loads);
    for (int i = 0; i < N_MECHANICAL; i++) x[i] += h / 6.0 * (sum[i] + k[i]);
    double *e = x + X_Q0;
    double scale = 1.0 / sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3]);
    for (int i = 0; i < 4; i++) e[i] *= scale;
    battery_advance(m, &m->power, h);
}

/* What the guidance needs. */
void airframe_motion(const Model *m, Motion *o) {
    const double *x = m->x;
    double R[9], ned[3], wind[3];
    rotation_matrix(x + X_Q0, R);
    rotate(R, x + X_U, ned);
    wind_in_body(m, R, wind);
    double u = x[X_U] - wind[0], side = x[X_V] - wind[1], w = x[X_W] - wind[2];
    o->north = x[X_NORTH];
    o->east = x[X_EAST];
    o->altitude = x[X_ALTITUDE];
    o->velocity_north = ned[0];
    o->velocity_east = ned[1];
    o->climb = -ned[2];
    o->airspeed = sqrt(u * u + side * side + w * w);
    o->beta = o->airspeed > SLOWEST ? clamp(side / o->airspeed, -1.0, 1.0) : 0.0; /* its sine: near enough */
    o->bank = angle_of(R[7], R[8]);
    o->pitch = -angle_of_sine(R[6]);
    double cos_pitch = sqrt(R[7] * R[7] + R[8] * R[8]), per = cos_pitch > 1e-9 ? 1.0 / cos_pitch : 0.0;
    o->sin_bank = R[7] * per;
    o->cos_bank = cos_pitch > 1e-9 ? R[8] * per : 1.0;
    o->p = x[X_P];
    o->q = x[X_Q];
    o->r = x[X_R];
}

/* The angles that only outputs need. */
void airframe_angles(const Model *m, Motion *o) {
    double R[9], wind[3];
    rotation_matrix(m->x + X_Q0, R);
    wind_in_body(m, R, wind);
    o->beta = angle_of_sine(o->beta);
    o->alpha = o->airspeed > SLOWEST ? angle_of(m->x[X_W] - wind[2], m->x[X_U] - wind[0]) : 0.0;
    o->heading = atan2(R[3], R[0]);
}
