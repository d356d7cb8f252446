/* Time: what is sampled, what happens, and what flows in between.
 * Guidance, autopilot, turbulence and the atmosphere are sampled on the model's own grid, the sun more rarely; no
 * step of the integration straddles a sample, so the importer's step size changes nothing. */
#include <math.h>
#include <string.h>

#include "model.h"

static int64_t sample_period(const Model *m) {
    return is_kinematic(m) ? GUIDANCE_PERIOD_KINEMATIC : GUIDANCE_PERIOD_6DOF;
}

/* Guidance needs an aircraft that answers to aileron and elevator. */
const char *model_command_problem(const Model *m) {
    bool steerable = m->v.aircraft_aero_Cl_aileron != 0.0 && m->v.aircraft_aero_Cm_elevator != 0.0;
    if (steerable || is_kinematic(m) || m->v.command_mode == MODE_DIRECT) return 0;
    return "command.mode: guidance needs aircraft.aero.Cl_aileron and Cm_elevator other than zero";
}

static void launch(Model *m) {
    m->events |= EVENT_RELEASED;
    m->flight = FLIGHT_LAUNCHED;
    if (!is_kinematic(m)) return;
    m->flight = FLIGHT_FLYING; /* no airspeed is too low for it, but none is zero */
    m->events |= EVENT_AIRBORNE;
    m->x[K_AIRSPEED] = m->v.launch_speed;
    guidance_forget(m);
}

/* What moves the surfaces at once: direct commands, or a launch under guidance. */
void model_surfaces(Model *m) {
    const Variables *v = &m->v;
    if (is_kinematic(m)) return;
    if (v->command_mode == MODE_DIRECT) {
        m->guidance.mode = MODE_DIRECT;
        m->demand.bank = m->demand.climb = m->guidance.cross_track = 0.0;
        m->actuator[0] = v->command_aileron;
        m->actuator[1] = v->command_elevator;
        m->actuator[2] = v->command_rudder;
        m->actuator[3] = v->command_throttle;
    } else if (m->flight != FLIGHT_FLYING) {
        m->actuator[0] = m->actuator[2] = 0.0;
        m->actuator[1] = m->trim.elevator;
        m->actuator[3] = m->flight == FLIGHT_LAUNCHED ? 1.0 : 0.0;
    }
}

/* What the inputs ask for at the beginning of a step or at an event. */
void model_inputs(Model *m) {
    if (m->flight == FLIGHT_HELD && m->v.command_launch != 0.0) launch(m);
    model_surfaces(m);
}

void model_motion(const Model *m, Motion *motion) {
    if (is_kinematic(m)) kinematic_motion(m, motion);
    else airframe_motion(m, motion);
}

/* Whether anything is sampled on the fine grid: if not, Model Exchange has no time events there. */
static bool is_sampled(const Model *m) {
    return !m->continuous || m->v.command_mode != MODE_DIRECT || m->v.turbulence_wind_speed > 0.0;
}

static bool has_sun(const Model *m) {
    return m->v.aircraft_battery_capacity > 0.0 && m->v.aircraft_solar_area > 0.0;
}

/* Time of the next sample [ns]; INT64_MAX if there is none. */
int64_t model_next_event(const Model *m) {
    int64_t fine = is_sampled(m) ? m->next_sample : INT64_MAX, sun = has_sun(m) ? m->next_sun : INT64_MAX;
    return fine < sun ? fine : sun;
}

/* Everything whose time has come. */
void model_sample(Model *m) {
    if (has_sun(m) && m->now >= m->next_sun) sun_sample(m);
    if (m->now < m->next_sample) return;
    double period = (double)sample_period(m) * 1e-9;
    m->next_sample = (m->now / sample_period(m) + 1) * sample_period(m);
    atmosphere_sample(m);
    bool guided = m->v.command_mode != MODE_DIRECT || is_kinematic(m), gusty = m->v.turbulence_wind_speed > 0.0;
    if (m->flight != FLIGHT_FLYING || !(guided || gusty)) return;
    Motion motion;
    model_motion(m, &motion);
    if (gusty) turbulence_sample(m, &motion, period);
    if (!guided) return;
    guidance_sample(m, &motion, period);
    if (!is_kinematic(m)) autopilot_sample(m, &motion, period);
}

static void integrate(Model *m, double h) {
    if (is_kinematic(m)) kinematic_advance(m, h);
    else airframe_advance(m, h);
    if (m->flight == FLIGHT_LAUNCHED) ground_rest(m);
}

/* Find the nanosecond of an event between now and `end` by bisection, and stop there. */
static void stop_at_event(Model *m, const double before[N_STATES], int64_t end) {
    int64_t low = m->now, high = end;
    while (high - low > 1) {
        int64_t middle = low + (high - low) / 2;
        memcpy(m->x, before, sizeof m->x);
        integrate(m, (double)(middle - m->now) * 1e-9);
        if (event_due(m)) high = middle;
        else low = middle;
    }
    memcpy(m->x, before, sizeof m->x);
    integrate(m, (double)(high - m->now) * 1e-9);
    m->now = high;
}

/* Four sums that do not wait for one another; a NaN or an infinity shows in their total. */
static bool finite_state(const Model *m) {
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i + 4 <= N_STATES - 2; i += 4)
        for (int j = 0; j < 4; j++) sum[j] += m->x[i + j];
    double total = sum[0] + sum[1] + sum[2] + sum[3] + m->x[X_THROTTLE];
    return fabs(total) < 1e12;
}

/* Go on until a time [ns], or to the first event if asked to stop there (it is left to the caller then). */
const char *model_advance(Model *m, int64_t until, bool stop_at_events) {
    const char *wrong = model_command_problem(m);
    if (wrong) return wrong;
    m->outputs_stale = true;
    model_inputs(m);
    while (m->now < until) {
        if (m->now >= m->next_sample) model_sample(m);
        int64_t end = m->next_sample < until ? m->next_sample : until;
        double before[N_STATES];
        memcpy(before, m->x, sizeof before);
        integrate(m, (double)(end - m->now) * 1e-9);
        if (!finite_state(m)) return "the state has diverged";
        if (event_due(m)) {
            stop_at_event(m, before, end);
            if (stop_at_events) return 0;
            model_events(m);
            model_inputs(m);
        } else {
            m->now = end;
        }
    }
    return 0;
}
