/* Life cycle and steps of an instance. No globals; any number of instances. */
#include "component.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_STEP 3600.0

static const char *const MODES[] = {"Instantiated", "Initialization Mode", "Step Mode", "Event Mode",
                                    "Continuous-Time Mode", "Terminated", "failed"};
static const char *const CATEGORIES[] = {"logStatusError", "logEvents"};

static void tell(const Component *c, int status, int category, const char *format, va_list arguments) {
    if (!c->logger || !c->logging[category]) return;
    char text[640];
    int used = snprintf(text, sizeof text, "%s: ", c->name);
    vsnprintf(text + used, sizeof text - (size_t)used, format, arguments);
    c->say(c, status, CATEGORIES[category], text);
}

int component_refuse(const Component *c, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell(c, STATUS_ERROR, LOG_ERROR, format, arguments);
    va_end(arguments);
    return STATUS_ERROR;
}

static void note(const Component *c, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell(c, STATUS_OK, LOG_EVENTS, format, arguments);
    va_end(arguments);
}

/* Whether a function may be called now. */
bool component_allowed(const Component *c, const char *function, unsigned modes) {
    if (!c) return false;
    if (modes & (1u << c->mode)) return true;
    component_refuse(c, "%s must not be called in state \"%s\"", function, MODES[c->mode]);
    return false;
}

Component *component_new(const char *name, const char *token, Interface interface, bool logging, void *environment,
                         void (*logger)(void), Say say) {
    Component *c = calloc(1, sizeof *c);
    if (!c) return 0;
    c->environment = environment;
    c->logger = logger;
    c->say = say;
    c->interface = interface;
    for (int i = 0; i < N_CATEGORIES; i++) c->logging[i] = logging;
    snprintf(c->name, sizeof c->name, "%s", name ? name : "");
    if (!token || strcmp(token, MODEL_TOKEN) != 0) {
        component_refuse(c, "instantiation token \"%.64s\" is not this model's %s", token ? token : "", MODEL_TOKEN);
        free(c);
        return 0;
    }
    c->model.continuous = interface == MODEL_EXCHANGE;
    model_defaults(&c->model);
    return c;
}

int component_log(Component *c, bool on, size_t n, const char *const categories[]) {
    bool chosen[N_CATEGORIES] = {false};
    for (size_t i = 0; i < n; i++) {
        int k = 0;
        while (k < N_CATEGORIES && categories && categories[i] && strcmp(categories[i], CATEGORIES[k]) != 0) k++;
        if (!categories || !categories[i] || k == N_CATEGORIES)
            return component_refuse(c, "unknown log category \"%.64s\"",
                                    categories && categories[i] ? categories[i] : "");
        chosen[k] = true;
    }
    for (int k = 0; k < N_CATEGORIES; k++)
        if (n == 0 || chosen[k]) c->logging[k] = on;
    return STATUS_OK;
}

int component_set_times(Component *c, double start, bool stop_defined, double stop) {
    if (!isfinite(start) || fabs(start) > 1e9) return component_refuse(c, "startTime = %g is not a usable time", start);
    if (stop_defined && !(stop >= start && isfinite(stop)))
        return component_refuse(c, "stopTime = %g is not after startTime = %g", stop, start);
    c->start_time = start;
    c->stop_defined = stop_defined;
    c->stop_time = stop;
    return STATUS_OK;
}

/* Initial state from the parameters as they are now; called for outputs in Initialization Mode as well. */
int component_initialise(Component *c) {
    const char *wrong = model_initialise(&c->model, c->start_time);
    return wrong ? component_refuse(c, "%s", wrong) : STATUS_OK;
}

int component_leave_initialization(Component *c, const char *function) {
    if (!component_allowed(c, function, IN_INITIALIZING)) return STATUS_ERROR;
    int status = component_initialise(c);
    if (status == STATUS_OK) c->mode = c->interface == MODEL_EXCHANGE || c->event_mode ? EVENT : STEPPING;
    return status;
}

int component_reset(Component *c) {
    if (!c) return STATUS_ERROR;
    model_defaults(&c->model);
    c->mode = INSTANTIATED;
    c->stop_defined = false;
    c->start_time = 0.0;
    return STATUS_OK;
}

/* What has happened, for the log. */
void component_tell_events(Component *c) {
    Model *m = &c->model;
    double time = c->start_time + (double)m->now / 1e9;
    if (!m->events) return;
    if (m->events & EVENT_RELEASED) note(c, "at t = %.9g s launch released", time);
    if (m->events & EVENT_AIRBORNE) note(c, "at t = %.9g s airborne", time);
    if (m->events & EVENT_CONTACT)
        note(c, "at t = %.9g s contact with the ground, descending at %.3g m/s", time, m->contact_speed);
    if (m->events & EVENT_RESERVE) note(c, "at t = %.9g s the battery is at its reserve", time);
    if (m->events & EVENT_EMPTY) note(c, "at t = %.9g s the battery is empty, the motor stops", time);
    m->events = 0;
}

static int check_step(const Component *c, double point, double step) {
    double now = c->start_time + (double)c->model.now / 1e9;
    if (!(step > 0.0 && step <= LONGEST_STEP))
        return component_refuse(c, "communicationStepSize = %g s is outside (0, %g]", step, LONGEST_STEP);
    if (!(fabs(point - now) <= 2e-9 + 1e-12 * fabs(now)))
        return component_refuse(c, "currentCommunicationPoint = %.12g s, but the model is at %.12g s", point, now);
    if (c->stop_defined && point + step > c->stop_time + 1e-9)
        return component_refuse(c, "the step from %g s by %g s goes beyond stopTime = %g s", point, step, c->stop_time);
    return STATUS_OK;
}

/* One communication step. Where the importer allows it, the step ends early at an event; where it handles events
 * itself the event is left to component_update. */
int component_step(Component *c, double point, double step, bool *event, bool *early, double *last) {
    if (check_step(c, point, step) != STATUS_OK) return STATUS_ERROR;
    Model *m = &c->model;
    int64_t until = (int64_t)llround((point - c->start_time + step) * 1e9);
    const char *wrong = model_advance(m, until, c->early_return || c->event_mode);
    *last = c->start_time + (double)m->now / 1e9;
    *early = !wrong && m->now < until;
    bool due = !wrong && (c->early_return || c->event_mode) && event_due(m);
    *event = due && c->event_mode;
    if (due && !c->event_mode) model_events(m);
    component_tell_events(c);
    if (!wrong) return STATUS_OK;
    c->mode = FAILED;
    return component_refuse(c, "at t = %.9g s %s", *last, wrong);
}
