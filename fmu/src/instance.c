/* One aircraft from its first instant on: start values, initial state, stepping, outputs. */
#include <math.h>
#include <string.h>

#define VARIABLE_FACTS
#include "model.h"

static bool kinematic(const Model *m) { return m->v.fidelity == FIDELITY_KINEMATIC; }

static int64_t guidance_period(const Model *m) {
    return kinematic(m) ? GUIDANCE_PERIOD_KINEMATIC : GUIDANCE_PERIOD_6DOF;
}

void model_defaults(Model *m) {
    memset(m, 0, sizeof *m);
    for (int i = 0; i < N_VARIABLES; i++) *(double *)((char *)&m->v + FACTS[i].offset) = FACTS[i].start;
}

static double density_here(const Model *m) {
    return air_density(m->v.environment_home_elevation + m->x[X_ALTITUDE]);
}

/* Attitude and velocity from the initial.* parameters; velocity is that of the air plus the wind. */
static void place_airframe(Model *m) {
    const Variables *v = &m->v;
    bool trimmed = v->initial_trimmed != 0.0;
    double alpha = trimmed ? m->trim.alpha : v->initial_alpha;
    double beta = trimmed ? 0.0 : v->initial_beta;
    double air[3] = {cos(alpha) * cos(beta), sin(beta), sin(alpha) * cos(beta)};
    double wind[3] = {v->wind_north, v->wind_east, v->wind_down}, wind_body[3];
    double *x = m->x;
    quaternion_from_euler(trimmed ? 0.0 : v->initial_bank, trimmed ? alpha : v->initial_pitch, v->initial_heading,
                          x + X_Q0);
    body_from_ground(x + X_Q0, wind, wind_body);
    for (int i = 0; i < 3; i++) x[X_U + i] = v->initial_airspeed * air[i] + wind_body[i];
    if (trimmed) {
        x[X_ELEVATOR] = m->trim.elevator;
        x[X_THROTTLE] = m->trim.throttle;
        return;
    }
    double rest[7] = {v->initial_p, v->initial_q, v->initial_r, v->initial_aileron, v->initial_elevator,
                      v->initial_rudder, v->initial_throttle};
    memcpy(x + X_P, rest, sizeof rest);
}

static void place_kinematic(Model *m) {
    const Variables *v = &m->v;
    m->x[K_AIRSPEED] = v->initial_airspeed;
    m->x[K_HEADING] = wrap(v->initial_heading);
    m->x[K_BANK] = v->initial_trimmed != 0.0 ? 0.0 : v->initial_bank;
    m->x[K_CLIMB] = -v->wind_down;
}

const char *model_initialise(Model *m, double start_time) {
    const Variables *v = &m->v;
    if (!inertia_is_real(v)) return "aircraft.inertia: no rigid body has these moments (triangle inequality)";
    if (v->aircraft_aero_Cl_aileron == 0.0 || v->aircraft_aero_Cm_elevator == 0.0)
        return "aircraft.aero: Cl_aileron and Cm_elevator must not be zero";
    if (v->aircraft_limits_min_airspeed > v->aircraft_limits_max_airspeed)
        return "aircraft.limits: min_airspeed is above max_airspeed";
    memset(m->x, 0, sizeof m->x);
    inertia_constants(v, &m->inertia);
    m->x[X_NORTH] = v->initial_north;
    m->x[X_EAST] = v->initial_east;
    m->x[X_ALTITUDE] = v->initial_altitude;
    m->density = density_here(m);
    bool level = trim_level(v, v->initial_airspeed, m->density, &m->trim);
    if (!level && v->initial_trimmed != 0.0 && !kinematic(m))
        return "initial.airspeed: the aircraft has no level trim at this airspeed and altitude";
    if (!level) memset(&m->trim, 0, sizeof m->trim);
    if (kinematic(m)) place_kinematic(m);
    else place_airframe(m);
    for (int i = 0; i < 4; i++) m->actuator[i] = m->x[X_AILERON + i];
    if (kinematic(m)) memset(m->actuator, 0, sizeof m->actuator);
    guidance_forget(m);
    autopilot_reset(m);
    m->demand.bank = 0.0;
    m->demand.climb = 0.0;
    m->demand.airspeed = v->initial_airspeed;
    m->start_time = start_time;
    m->now = 0;
    m->next_sample = 0;
    m->outputs_stale = true;
    return 0;
}

static void read_motion(const Model *m, Motion *motion) {
    if (kinematic(m)) kinematic_motion(m, motion);
    else airframe_motion(m, motion);
}

/* The sampled part: density, guidance, autopilot. */
static void sample(Model *m) {
    double period = (double)guidance_period(m) * 1e-9;
    Motion motion;
    read_motion(m, &motion);
    m->density = density_here(m);
    guidance_sample(m, &motion, period);
    if (kinematic(m)) return;
    if (m->v.command_mode != MODE_DIRECT) autopilot_sample(m, &motion, period);
}

static bool finite_state(const Model *m) {
    double sum = 0.0;
    for (int i = 0; i < N_STATES; i++) sum += m->x[i];
    return isfinite(sum) && fabs(sum) < 1e12;
}

/* Go on until a time [ns]. A substep never straddles a sample of the guidance, which has its own grid. */
const char *model_advance(Model *m, int64_t until) {
    const int64_t period = guidance_period(m);
    if (m->v.command_mode == MODE_DIRECT && !kinematic(m)) {
        m->actuator[0] = m->v.command_aileron;
        m->actuator[1] = m->v.command_elevator;
        m->actuator[2] = m->v.command_rudder;
        m->actuator[3] = m->v.command_throttle;
    }
    m->outputs_stale = true;
    while (m->now < until) {
        if (m->now == m->next_sample) {
            sample(m);
            m->next_sample += period;
        }
        int64_t end = m->next_sample < until ? m->next_sample : until;
        double h = (double)(end - m->now) * 1e-9;
        if (kinematic(m)) kinematic_advance(m, h);
        else airframe_advance(m, h);
        m->now = end;
        if (m->now == m->next_sample && !finite_state(m)) return "the state has diverged";
    }
    return finite_state(m) ? 0 : "the state has diverged";
}

static void airframe_outputs(Model *m) {
    Variables *v = &m->v;
    double dx[N_STATES];
    Loads loads;
    airframe_derivative(m, m->x, dx, &loads);
    memcpy(&v->state_quaternion_w, m->x + X_Q0, 4 * sizeof(double));
    memcpy(&v->state_u, m->x + X_U, 3 * sizeof(double));
    memcpy(&v->state_aileron, m->x + X_AILERON, 4 * sizeof(double));
    memcpy(&v->rate_u, dx + X_U, 10 * sizeof(double)); /* velocity, quaternion, body rates */
    double per_mass = 1.0 / v->aircraft_mass;
    v->sensor_specific_force_x = loads.force[0] * per_mass;
    v->sensor_specific_force_y = loads.force[1] * per_mass;
    v->sensor_specific_force_z = loads.force[2] * per_mass;
    v->engine_thrust = loads.thrust;
    v->state_stalled = loads.stalled;
}

/* The kinematic aircraft turns without sideslip and feels its lift along body up. */
static void kinematic_outputs(Model *m, const Motion *o) {
    Variables *v = &m->v;
    double q[4], ned[3] = {o->velocity_north, o->velocity_east, -o->climb}, body[3];
    quaternion_from_euler(o->bank, o->pitch, o->heading, q);
    body_from_ground(q, ned, body);
    memcpy(&v->state_quaternion_w, q, sizeof q);
    memcpy(&v->state_u, body, sizeof body);
    memset(&v->state_aileron, 0, 4 * sizeof(double));
    memset(&v->rate_u, 0, 10 * sizeof(double));
    v->sensor_specific_force_x = v->environment_gravity * sin(o->pitch);
    v->sensor_specific_force_y = 0.0;
    v->sensor_specific_force_z = -v->environment_gravity / cos(o->bank);
    v->engine_thrust = 0.0;
    v->state_stalled = 0.0;
}

void model_outputs(Model *m) {
    Variables *v = &m->v;
    Motion o;
    read_motion(m, &o);
    m->outputs_stale = false;
    v->time = m->start_time + (double)m->now / 1e9;
    v->state_north = o.north;
    v->state_east = o.east;
    v->state_altitude = o.altitude;
    v->state_velocity_north = o.velocity_north;
    v->state_velocity_east = o.velocity_east;
    v->state_velocity_down = -o.climb;
    v->state_climb_rate = o.climb;
    v->state_airspeed = o.airspeed;
    v->state_heading = o.heading;
    v->state_bank = o.bank;
    v->state_pitch = o.pitch;
    v->state_p = o.p;
    v->state_q = o.q;
    v->state_r = o.r;
    v->state_alpha = o.alpha;
    v->state_beta = o.beta;
    v->state_ground_speed = hypot(o.velocity_north, o.velocity_east);
    v->state_course = atan2(o.velocity_east, o.velocity_north);
    if (kinematic(m)) kinematic_outputs(m, &o);
    else airframe_outputs(m);
    v->sensor_load_factor = v->environment_gravity > 0.0 ? -v->sensor_specific_force_z / v->environment_gravity : 0.0;
    v->air_density = m->density;
    v->guidance_cross_track = m->guidance.cross_track;
    v->guidance_bank_command = m->demand.bank;
    v->guidance_climb_command = m->demand.climb;
}
