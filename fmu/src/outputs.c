/* Outputs: all of them from state and inputs, once per step and only when one is asked for. */
#include <math.h>
#include <string.h>

#include "model.h"

/* Derivatives of the state, for an importer that integrates. */
void model_derivative(Model *m, double dx[N_STATES]) {
    Loads loads;
    model_surfaces(m);
    airframe_derivative(m, m->x, dx, &loads);
    dx[X_ENERGY] = power_balance(m, m->x[X_ENERGY], loads.thrust * loads.airspeed, loads.sunlight).stored;
}

static Power airframe_outputs(Model *m) {
    Variables *v = &m->v;
    double dx[N_STATES];
    Loads loads;
    airframe_derivative(m, m->x, dx, &loads);
    memcpy(&v->state_quaternion_w, m->x + X_Q0, 4 * sizeof(double));
    memcpy(&v->state_u, m->x + X_U, 3 * sizeof(double));
    memcpy(&v->state_aileron, m->x + X_AILERON, 4 * sizeof(double));
    memcpy(&v->rate_u, dx + X_U, 14 * sizeof(double)); /* velocity, quaternion, body rates, actuators */
    double per_mass = 1.0 / v->aircraft_mass;
    v->sensor_specific_force_x = loads.force[0] * per_mass;
    v->sensor_specific_force_y = loads.force[1] * per_mass;
    v->sensor_specific_force_z = loads.force[2] * per_mass;
    v->engine_thrust = loads.thrust;
    v->state_stalled = loads.stalled;
    return power_balance(m, m->x[X_ENERGY], loads.thrust * loads.airspeed, loads.sunlight);
}

/* The kinematic aircraft turns without sideslip and feels its lift along body up. */
static Power kinematic_outputs(Model *m, const Motion *o) {
    Variables *v = &m->v;
    double q[4], R[9], ned[3] = {o->velocity_north, o->velocity_east, -o->climb}, body[3];
    quaternion_from_euler(o->bank, o->pitch, o->heading, q);
    rotation_matrix(q, R);
    rotate_back(R, ned, body);
    double gravity = gravity_at(v, o->altitude);
    memcpy(&v->state_quaternion_w, q, sizeof q);
    memcpy(&v->state_u, body, sizeof body);
    memset(&v->state_aileron, 0, 4 * sizeof(double));
    memset(&v->rate_u, 0, 14 * sizeof(double));
    v->sensor_specific_force_x = gravity * sin(o->pitch);
    v->sensor_specific_force_y = 0.0;
    v->sensor_specific_force_z = -gravity / cos(o->bank);
    v->engine_thrust = 0.0;
    v->state_stalled = 0.0;
    return m->power;
}

static void motion_outputs(Variables *v, const Motion *o) {
    v->state_north = o->north;
    v->state_east = o->east;
    v->state_altitude = o->altitude;
    v->state_velocity_north = o->velocity_north;
    v->state_velocity_east = o->velocity_east;
    v->state_velocity_down = -o->climb;
    v->state_climb_rate = o->climb;
    v->state_airspeed = o->airspeed;
    v->state_heading = o->heading;
    v->state_bank = o->bank;
    v->state_pitch = o->pitch;
    v->state_p = o->p;
    v->state_q = o->q;
    v->state_r = o->r;
    v->state_alpha = o->alpha;
    v->state_beta = o->beta;
    v->state_ground_speed = sqrt(o->velocity_north * o->velocity_north + o->velocity_east * o->velocity_east);
    v->state_course = v->state_ground_speed > 0.0 ? atan2(o->velocity_east, o->velocity_north) : o->heading;
}

/* What air data sensors read, without noise: the pitot tube's pressure is that of incompressible flow. */
static void air_outputs(Model *m, const Motion *o) {
    Variables *v = &m->v;
    Air air = air_at(v->environment_home_elevation + o->altitude);
    v->air_density = air.density;
    v->sensor_static_pressure = air.pressure;
    v->sensor_differential_pressure = 0.5 * air.density * o->airspeed * o->airspeed;
    v->sensor_temperature = air.temperature;
    memcpy(&v->air_gust_north, m->turbulence.gust, 3 * sizeof(double));
}

static void power_outputs(Model *m, const Power *power) {
    Variables *v = &m->v;
    double capacity = v->aircraft_battery_capacity;
    v->battery_energy = m->x[X_ENERGY];
    v->battery_state_of_charge = capacity > 0.0 ? m->x[X_ENERGY] / capacity : 0.0;
    v->battery_power_in = power->solar;
    v->battery_power_out = power->consumed;
    v->battery_power_stored = power->stored;
    v->battery_empty = m->empty;
    v->battery_on_reserve = m->on_reserve;
    v->sun_elevation = m->sun.elevation;
    v->sun_azimuth = m->sun.azimuth;
    v->sun_irradiance = m->sun.direct * (m->sun.elevation > 0.0 ? sin(m->sun.elevation) : 0.0) + m->sun.diffuse;
}

void model_outputs(Model *m) {
    Variables *v = &m->v;
    Motion o;
    m->outputs_stale = false;
    model_surfaces(m);
    model_motion(m, &o);
    if (!is_kinematic(m)) airframe_angles(m, &o);
    v->time = m->start_time + (double)m->now / 1e9;
    motion_outputs(v, &o);
    Power power = is_kinematic(m) ? kinematic_outputs(m, &o) : airframe_outputs(m);
    double gravity = gravity_at(v, o.altitude);
    v->sensor_load_factor = gravity > 0.0 ? -v->sensor_specific_force_z / gravity : 0.0;
    v->state_elevon_left = v->state_elevator + v->state_aileron;
    v->state_elevon_right = v->state_elevator - v->state_aileron;
    air_outputs(m, &o);
    power_outputs(m, &power);
    v->flight_phase = m->flight;
    v->flight_contact_speed = m->contact_speed;
    v->guidance_cross_track = m->guidance.cross_track;
    v->guidance_bank_command = m->demand.bank;
    v->guidance_climb_command = m->demand.climb;
    double indicators[N_INDICATORS];
    model_indicators(m, indicators);
    memcpy(&v->event_ground, indicators, sizeof indicators);
}
