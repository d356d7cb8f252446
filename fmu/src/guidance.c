/* Guidance: a leg or an orbit, an altitude and an airspeed in; bank, climb and airspeed demands out.
 * The only guidance there is; both fidelities fly it. */
#include <math.h>
#include <string.h>

#include "model.h"

#define DEGREES (180.0 / PI)
#define PAPER_PERIOD 0.01        /* Eq. 20 [s] */
#define PAPER_REACH 500.0        /* |DD| is clipped here [m] */
#define STEEPEST 0.7071067811865475 /* sine of the L1 intercept angle: 45 deg */
#define REVERSAL -0.9510565162951535 /* cosine of 0.9 pi: beyond, the side of a turn, once chosen, is kept */

typedef struct {
    double cross_track;              /* right of the leg positive [m] */
    double along_speed, cross_speed; /* ground velocity along and to the right of the leg [m/s] */
} LegGeometry;

void guidance_forget(Model *m) {
    memset(&m->guidance, 0, sizeof m->guidance);
    m->guidance.mode = -1;
}

/* The leg's memory (DD_old, roll command, side of a turn) belongs to one leg and dies with it. */
static void notice_leg(Model *m, const Motion *o) {
    const Variables *v = &m->v;
    GuidanceMemory *g = &m->guidance;
    double leg[4] = {v->command_leg_from_north, v->command_leg_from_east, v->command_leg_to_north,
                     v->command_leg_to_east};
    if (g->leg_known && memcmp(leg, g->leg, sizeof leg) == 0) return;
    memcpy(g->leg, leg, sizeof leg);
    g->leg_known = true;
    g->cross_track_known = false;
    g->bank_command_deg = 0.0;
    g->turn_sign = 0.0;
    bool a_point = hypot(leg[2] - leg[0], leg[3] - leg[1]) < 1.0; /* then straight to it from here */
    g->origin_north = a_point ? o->north : leg[0];
    g->origin_east = a_point ? o->east : leg[1];
    double north = leg[2] - g->origin_north, east = leg[3] - g->origin_east;
    if (hypot(north, east) < 1e-6) { /* on the point: fly on as we go */
        north = o->velocity_north;
        east = o->velocity_east;
    }
    double length = hypot(north, east);
    g->line_north = length > 1e-6 ? north / length : 1.0;
    g->line_east = length > 1e-6 ? east / length : 0.0;
}

static LegGeometry leg_geometry(const GuidanceMemory *g, const Motion *o) {
    LegGeometry l;
    l.cross_track = g->line_north * (o->east - g->origin_east) - g->line_east * (o->north - g->origin_north);
    l.along_speed = g->line_north * o->velocity_north + g->line_east * o->velocity_east;
    l.cross_speed = g->line_north * o->velocity_east - g->line_east * o->velocity_north;
    return l;
}

/* Eqs. 15, 19, 20, in degrees (erratum E22). DD is positive left of the leg (E20).
 * Differs from the paper: DD clipped at 500 m (E23), command clamped to the bank limit (E23), memory reset
 * at a new leg (E24), and increments scaled with the period where it is not 0.01 s. */
static double bank_by_paper(Model *m, const LegGeometry *l, double period) {
    GuidanceMemory *g = &m->guidance;
    double DD = -l->cross_track;
    double DD_old = g->cross_track_known ? g->cross_track_old : DD;
    double DD_rate = (DD - DD_old) / period;
    double command = g->bank_command_deg;
    double increment = (clamp(DD, -PAPER_REACH, PAPER_REACH) * 0.001 + DD_rate * 0.05) * 0.1 - command * 0.01;
    double limit = m->v.guidance_max_bank * DEGREES;
    g->bank_command_deg = clamp(command + increment * (period / PAPER_PERIOD), -limit, limit);
    g->cross_track_old = DD;
    g->cross_track_known = true;
    return g->bank_command_deg / DEGREES;
}

static inline double bank_for(const Model *m, double lateral_acceleration) {
    const Variables *v = &m->v;
    double limit = v->guidance_max_bank, scale = v->aircraft_kinematic_turn_factor * m->gravity;
    if (scale <= 0.0) return 0.0; /* without weight no bank turns anything */
    return clamp(angle_of(lateral_acceleration, scale), -limit, limit);
}

/* Inverse of the look-ahead time L1/V [1/s] for a damping and period (Park et al. 2004; Curry's form in ArduPilot). */
static double per_l1_time(const Variables *v) { return PI / (v->guidance_l1_damping * v->guidance_l1_period); }

/* Lateral acceleration that turns the ground velocity by an angle: K V2/L1 sin(angle), K = 4 damping2, and no
 * less than at a right angle beyond one. Near a reversal of course the side that was chosen first is kept.
 * The angle is given by sine and cosine: no angle need be found. */
static double l1_acceleration(Model *m, double speed, double sine, double cosine) {
    GuidanceMemory *g = &m->guidance;
    double damping = m->v.guidance_l1_damping, side = sine < 0.0 ? -1.0 : 1.0;
    if (cosine > REVERSAL) g->turn_sign = 0.0;
    else if (g->turn_sign == 0.0) g->turn_sign = side;
    else side = g->turn_sign;
    return 4.0 * damping * damping * per_l1_time(&m->v) * speed * (cosine >= 0.0 ? sine : side);
}

static double bank_by_l1(Model *m, const LegGeometry *l) {
    double speed = sqrt(l->along_speed * l->along_speed + l->cross_speed * l->cross_speed);
    if (speed < 0.1) speed = 0.1;
    double per = 1.0 / speed, sc = l->cross_speed * per, cc = l->along_speed * per; /* course */
    double intercept = l->cross_track * per * per_l1_time(&m->v);
    double si = -clamp(intercept, -STEEPEST, STEEPEST), ci = sqrt(1.0 - si * si);
    return bank_for(m, l1_acceleration(m, speed, si * cc - ci * sc, ci * cc + si * sc));
}

/* A course field that winds on to the circle, flown with the L1 law, plus the circle's own acceleration. */
static double bank_for_orbit(Model *m, const Motion *o) {
    const Variables *v = &m->v;
    double north = o->north - v->command_orbit_north, east = o->east - v->command_orbit_east;
    double range = sqrt(north * north + east * east);
    double direction = v->command_orbit_direction < 0.0 ? -1.0 : 1.0;
    double speed = sqrt(o->velocity_north * o->velocity_north + o->velocity_east * o->velocity_east);
    if (speed < 0.1) speed = 0.1;
    double distance = speed / per_l1_time(v), excess = range - v->command_orbit_radius;
    m->guidance.cross_track = excess;
    double rn = range > 1e-6 ? north / range : 1.0, re = range > 1e-6 ? east / range : 0.0;
    double per_slant = 1.0 / sqrt(distance * distance + excess * excess);
    double ci = distance * per_slant, si = excess * per_slant; /* inwards */
    double wn = -si * rn - direction * ci * re, we = -si * re + direction * ci * rn;   /* course wanted */
    double cn = o->velocity_north / speed, ce = o->velocity_east / speed;              /* course flown */
    double sine = cn * we - ce * wn, cosine = cn * wn + ce * we;
    double around = range > 0.5 * v->command_orbit_radius ? range : 0.5 * v->command_orbit_radius;
    double centripetal = direction * speed * speed / around * ci * clamp(cosine, 0.0, 1.0);
    return bank_for(m, l1_acceleration(m, speed, sine, cosine) + centripetal);
}

/* Climb [m/s] towards the commanded altitude; less of it when airspeed is being lost or gained. */
static double climb_demand(const Model *m, const Motion *o, double airspeed, double period) {
    const Variables *v = &m->v;
    double error = v->command_altitude - o->altitude;
    double slow = clamp(o->airspeed - airspeed + 2.0, 0.0, 1.0);
    double fast = clamp(airspeed - o->airspeed + 2.0, 0.0, 1.0);
    double wanted = clamp(error / v->aircraft_control_altitude_time, -v->aircraft_limits_sink_rate * fast,
                          v->aircraft_limits_climb_rate * slow);
    double slew = v->aircraft_control_climb_acceleration * period;
    return m->guidance.climb_command + clamp(wanted - m->guidance.climb_command, -slew, slew);
}

void guidance_sample(Model *m, const Motion *o, double period) {
    const Variables *v = &m->v;
    GuidanceMemory *g = &m->guidance;
    int mode = (int)v->command_mode;
    if (mode != g->mode) {
        if (g->mode == MODE_DIRECT) autopilot_reset(m);
        g->mode = mode;
        g->leg_known = false;
        g->turn_sign = 0.0;
    }
    g->cross_track = 0.0;
    if (mode == MODE_LEG) {
        notice_leg(m, o);
        LegGeometry l = leg_geometry(g, o);
        g->cross_track = l.cross_track;
        m->demand.bank = v->guidance_law == LAW_PAPER ? bank_by_paper(m, &l, period) : bank_by_l1(m, &l);
    } else if (mode == MODE_ORBIT) {
        m->demand.bank = bank_for_orbit(m, o);
    } else {
        m->demand.bank = 0.0;
    }
    m->demand.airspeed = clamp(v->command_airspeed, v->aircraft_limits_min_airspeed, v->aircraft_limits_max_airspeed);
    m->demand.climb = climb_demand(m, o, m->demand.airspeed, period);
    g->climb_command = m->demand.climb;
}
