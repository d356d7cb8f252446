/* The ground: held, launched, flying, landed; and the events that lead from one to the next.
 *
 * Before its launch the aircraft stands, or rests on the catapult, with the nose raised by launch.pitch.
 * Catapult: constant acceleration along the body's forward axis up to launch.speed over launch.length.
 * Runway: it rolls level on its wheels, held at launch.pitch, until it is as fast through the air as launch.speed
 * and the air carries its weight.
 * A contact ends the flight where it happens: sliding and bouncing are not modelled. */
#include <math.h>
#include <string.h>

#include "model.h"

#define CLEARANCE 1.0 /* a contact counts once the aircraft has been this high [m] */

/* Force of the ground [N] that carries what the air does not; negative: the aircraft lifts off. */
static double ground_reaction(const Model *m, const double R[9], const Loads *loads, double altitude) {
    double air = R[6] * loads->force[0] + R[7] * loads->force[1] + R[8] * loads->force[2];
    return m->v.aircraft_mass * gravity_at(&m->v, altitude) + air;
}

/* Acceleration along the launch [m/s2]. */
static double launch_acceleration(const Model *m, const double x[], const double R[9], const Loads *loads) {
    const Variables *v = &m->v;
    if (v->launch_mode == LAUNCH_CATAPULT) return 0.5 * v->launch_speed * v->launch_speed / v->launch_length;
    double reaction = ground_reaction(m, R, loads, x[X_ALTITUDE]);
    double cp = sqrt(1.0 - clamp(R[6] * R[6], 0.0, 1.0));
    double ahead = loads->force[0] * cp - loads->force[2] * R[6];
    double force = ahead - v->launch_friction * (reaction > 0.0 ? reaction : 0.0);
    return force > 0.0 || x[X_U] > 0.0 ? force / v->aircraft_mass : 0.0;
}

/* Replaces the motion that air and weight would give by what the ground allows; loads become what is felt. */
void ground_motion(const Model *m, const double x[], const double R[9], Loads *loads, double dx[]) {
    const Variables *v = &m->v;
    double along[3] = {1.0, 0.0, 0.0}, acceleration = 0.0;
    if (v->launch_mode == LAUNCH_RUNWAY) {
        along[0] = sqrt(1.0 - clamp(R[6] * R[6], 0.0, 1.0)); /* level: sin(pitch) = -R[6] */
        along[2] = -R[6];
        dx[X_ALTITUDE] = 0.0;
    }
    if (m->flight == FLIGHT_LAUNCHED) acceleration = launch_acceleration(m, x, R, loads);
    memset(dx + X_Q0, 0, 7 * sizeof(double));
    double gravity = gravity_at(v, x[X_ALTITUDE]);
    for (int i = 0; i < 3; i++) {
        dx[X_U + i] = acceleration * along[i];
        loads->force[i] = v->aircraft_mass * (dx[X_U + i] - gravity * R[6 + i]);
        loads->moment[i] = 0.0;
    }
}

/* Friction stops a rolling aircraft, it does not push it back: after a run-up that is broken off it stands. */
void ground_rest(Model *m) {
    if (m->v.launch_mode == LAUNCH_RUNWAY && m->x[X_U] < 0.0) memset(m->x + X_U, 0, 3 * sizeof(double));
}

static double launch_indicator(const Model *m) {
    const double *x = m->x;
    if (m->v.launch_mode == LAUNCH_CATAPULT)
        return m->v.launch_speed - sqrt(x[X_U] * x[X_U] + x[X_V] * x[X_V] + x[X_W] * x[X_W]);
    Model flying = *m; /* loads of the air alone: ground_motion would replace them */
    flying.flight = FLIGHT_FLYING;
    double R[9], dx[N_STATES];
    Loads loads;
    airframe_derivative(&flying, x, dx, &loads);
    rotation_matrix(x + X_Q0, R);
    double weight = ground_reaction(m, R, &loads, x[X_ALTITUDE]) / (m->v.aircraft_mass * 10.0);
    double slow = 1.0 - loads.airspeed / m->v.launch_speed;
    return weight > slow ? weight : slow;
}

void model_indicators(const Model *m, double z[N_INDICATORS]) {
    z[INDICATOR_GROUND] = z[INDICATOR_LAUNCH] = z[INDICATOR_BATTERY] = 1.0;
    if (m->flight == FLIGHT_FLYING && m->v.ground_present != 0.0) {
        double height = m->x[X_ALTITUDE] - m->v.ground_elevation;
        z[INDICATOR_GROUND] = m->clear_of_ground ? height : CLEARANCE - height;
    }
    if (m->flight == FLIGHT_LAUNCHED) z[INDICATOR_LAUNCH] = launch_indicator(m);
    double capacity = m->v.aircraft_battery_capacity;
    if (capacity > 0.0 && !m->empty) {
        double mark = m->on_reserve ? 0.0 : m->v.aircraft_battery_reserve * capacity;
        z[INDICATOR_BATTERY] = (m->x[X_ENERGY] - mark) * 1e-5;
    }
}

bool event_due(const Model *m) {
    double z[N_INDICATORS];
    model_indicators(m, z);
    return z[0] <= 0.0 || z[1] <= 0.0 || z[2] <= 0.0;
}

static void touch_down(Model *m) {
    double *x = m->x;
    Motion o;
    model_motion(m, &o);
    if (!is_kinematic(m)) airframe_angles(m, &o);
    m->contact_speed = -o.climb;
    if (is_kinematic(m)) {
        x[K_AIRSPEED] = x[K_CLIMB] = x[K_BANK] = 0.0;
    } else {
        memset(x + X_U, 0, 3 * sizeof(double));
        memset(x + X_P, 0, 3 * sizeof(double));
        quaternion_from_euler(0.0, 0.0, o.heading, x + X_Q0);
    }
    x[X_ALTITUDE] = m->v.ground_elevation;
    m->flight = FLIGHT_LANDED;
}

/* Carry out what is due. True if the state has jumped. */
bool model_events(Model *m) {
    double z[N_INDICATORS];
    bool jumped = false;
    model_indicators(m, z);
    if (z[INDICATOR_LAUNCH] <= 0.0) {
        m->flight = FLIGHT_FLYING;
        m->events |= EVENT_AIRBORNE;
        guidance_forget(m);
        autopilot_reset(m);
    }
    if (z[INDICATOR_GROUND] <= 0.0 && !m->clear_of_ground) {
        m->clear_of_ground = true;
        m->events |= EVENT_CLEAR;
    } else if (z[INDICATOR_GROUND] <= 0.0) {
        touch_down(m);
        m->events |= EVENT_CONTACT;
        jumped = true;
    }
    if (z[INDICATOR_BATTERY] <= 0.0) {
        m->events |= m->on_reserve ? EVENT_EMPTY : EVENT_RESERVE;
        m->empty = m->on_reserve;
        m->on_reserve = true;
    }
    return jumped;
}
