/* One aircraft at its first instant: start values, and the initial state that the parameters give. */
#include <math.h>
#include <string.h>

#include "model.h"

void quaternion_from_euler(double bank, double pitch, double heading, double q[4]) {
    double cr = cos(0.5 * bank), sr = sin(0.5 * bank);
    double cp = cos(0.5 * pitch), sp = sin(0.5 * pitch);
    double cy = cos(0.5 * heading), sy = sin(0.5 * heading);
    q[0] = cr * cp * cy + sr * sp * sy;
    q[1] = sr * cp * cy - cr * sp * sy;
    q[2] = cr * sp * cy + sr * cp * sy;
    q[3] = cr * cp * sy - sr * sp * cy;
}

void model_defaults(Model *m) {
    bool continuous = m->continuous;
    memset(m, 0, sizeof *m);
    m->continuous = continuous;
    for (int i = 0; i < N_VARIABLES; i++) *(double *)((char *)&m->v + FACTS[i].offset) = FACTS[i].start;
}

/* Attitude and velocity from the initial.* parameters; velocity is that of the air plus the wind. */
static void place_in_the_air(Model *m) {
    const Variables *v = &m->v;
    bool trimmed = v->initial_trimmed != 0.0;
    double alpha = trimmed ? m->trim.alpha : v->initial_alpha;
    double beta = trimmed ? 0.0 : v->initial_beta;
    double air[3] = {cos(alpha) * cos(beta), sin(beta), sin(alpha) * cos(beta)};
    double wind[3] = {v->wind_north, v->wind_east, v->wind_down}, wind_body[3], R[9];
    double *x = m->x;
    quaternion_from_euler(trimmed ? 0.0 : v->initial_bank, trimmed ? alpha : v->initial_pitch, v->initial_heading,
                          x + X_Q0);
    rotation_matrix(x + X_Q0, R);
    rotate_back(R, wind, wind_body);
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

/* On the ground or on the catapult: at rest, elevator where the flight will need it. */
static void place_on_the_ground(Model *m) {
    m->x[X_ALTITUDE] = m->v.ground_elevation;
    quaternion_from_euler(0.0, m->v.launch_pitch, m->v.initial_heading, m->x + X_Q0);
    m->x[X_ELEVATOR] = m->trim.elevator;
}

static void place_kinematic(Model *m) {
    const Variables *v = &m->v;
    bool held = m->flight == FLIGHT_HELD;
    m->x[K_AIRSPEED] = held ? 0.0 : v->initial_airspeed;
    m->x[K_HEADING] = wrap(v->initial_heading);
    m->x[K_BANK] = held || v->initial_trimmed != 0.0 ? 0.0 : v->initial_bank;
    m->x[K_CLIMB] = held ? 0.0 : -v->wind_down;
    if (held) m->x[K_ALTITUDE] = v->ground_elevation;
}

static const char *impossible(const Model *m) {
    const Variables *v = &m->v;
    if (!inertia_is_real(v)) return "aircraft.inertia: no rigid body has these moments (triangle inequality)";
    if (v->aircraft_limits_min_airspeed > v->aircraft_limits_max_airspeed)
        return "aircraft.limits: min_airspeed is above max_airspeed";
    if (m->continuous && is_kinematic(m))
        return "fidelity: the kinematic aircraft is a sampled system of its own and is there in Co-Simulation only";
    if (v->launch_mode != LAUNCH_NONE && v->ground_present == 0.0)
        return "launch.mode: there is no ground to start from (ground.present is false)";
    return model_command_problem(m);
}

static void reset_memory(Model *m, double start_time) {
    guidance_forget(m);
    autopilot_reset(m);
    turbulence_reset(m);
    m->demand.bank = m->demand.climb = 0.0;
    m->demand.airspeed = m->v.initial_airspeed;
    m->start_time = start_time;
    m->contact_speed = 0.0;
    m->now = m->next_sample = m->next_power = 0;
    m->events = 0;
    m->clear_of_ground = m->empty = m->on_reserve = false;
    m->outputs_stale = true;
    sun_sample(m);
    m->next_sun = 0;
}

const char *model_initialise(Model *m, double start_time) {
    const Variables *v = &m->v;
    const char *wrong = impossible(m);
    if (wrong) return wrong;
    memset(m->x, 0, sizeof m->x);
    inertia_constants(v, &m->inertia);
    m->per_mass = 1.0 / v->aircraft_mass;
    m->per_surface_time = 1.0 / v->aircraft_actuator_surface_time;
    m->per_throttle_time = 1.0 / v->aircraft_actuator_throttle_time;
    m->flight = v->launch_mode != LAUNCH_NONE ? FLIGHT_HELD : FLIGHT_FLYING;
    m->x[X_NORTH] = v->initial_north;
    m->x[X_EAST] = v->initial_east;
    m->x[X_ALTITUDE] = v->initial_altitude;
    m->x[X_ENERGY] = v->initial_charge * v->aircraft_battery_capacity;
    m->air.density = 0.0;
    atmosphere_sample(m);
    bool level = trim_level(v, v->initial_airspeed, m->air.density, m->gravity, &m->trim);
    bool needed = v->initial_trimmed != 0.0 && m->flight == FLIGHT_FLYING && !is_kinematic(m);
    if (!level && needed) return "initial.airspeed: the aircraft has no level trim at this airspeed and altitude";
    if (!level) memset(&m->trim, 0, sizeof m->trim);
    if (is_kinematic(m)) place_kinematic(m);
    else if (m->flight == FLIGHT_HELD) place_on_the_ground(m);
    else place_in_the_air(m);
    m->air.density = 0.0;
    atmosphere_sample(m); /* the ground may be elsewhere */
    memset(m->actuator, 0, sizeof m->actuator);
    if (!is_kinematic(m)) memcpy(m->actuator, m->x + X_AILERON, sizeof m->actuator);
    reset_memory(m, start_time);
    return 0;
}
