/* Events, and Model Exchange: the importer integrates the state. */
#include "component.h"

#include <math.h>
#include <string.h>

static const double NOMINALS[N_STATES] = {100.0, 100.0, 100.0, 10.0, 10.0, 10.0, 1.0, 1.0, 1.0, 1.0,
                                          1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1e5};

/* An event has come: carry out what is due and sample what is to be sampled. */
int component_update(Component *c, EventInfo *info) {
    Model *m = &c->model;
    const char *wrong = model_command_problem(m);
    if (wrong) return component_refuse(c, "%s", wrong);
    info->states_changed = false;
    while (event_due(m)) info->states_changed |= model_events(m); /* at most the three indicators' events */
    model_inputs(m);
    if (m->continuous) model_sample(m);
    component_tell_events(c);
    m->outputs_stale = true;
    int64_t next = m->continuous ? model_next_event(m) : INT64_MAX;
    info->time_defined = next != INT64_MAX;
    info->time = info->time_defined ? c->start_time + (double)next / 1e9 : 0.0;
    return STATUS_OK;
}

int component_set_time(Component *c, double time) {
    double since = time - c->start_time;
    if (!(since >= -1e-9 && since < 1e9)) return component_refuse(c, "time = %g s is before the start or too late", time);
    c->model.now = (int64_t)llround(since * 1e9);
    c->model.outputs_stale = true;
    return STATUS_OK;
}

static int check_count(const Component *c, const void *array, size_t n, size_t expected) {
    if (n == expected && array) return STATUS_OK;
    return component_refuse(c, "an array of %zu is needed, not of %zu", expected, array ? n : (size_t)0);
}

int component_get_states(const Component *c, double states[], size_t n) {
    if (check_count(c, states, n, N_STATES) != STATUS_OK) return STATUS_ERROR;
    memcpy(states, c->model.x, sizeof c->model.x);
    return STATUS_OK;
}

int component_set_states(Component *c, const double states[], size_t n) {
    if (check_count(c, states, n, N_STATES) != STATUS_OK) return STATUS_ERROR;
    for (size_t i = 0; i < n; i++)
        if (!(fabs(states[i]) < 1e12)) return component_refuse(c, "continuous state %zu = %g is not usable", i, states[i]);
    memcpy(c->model.x, states, sizeof c->model.x);
    c->model.outputs_stale = true;
    return STATUS_OK;
}

int component_get_derivatives(Component *c, double derivatives[], size_t n) {
    if (check_count(c, derivatives, n, N_STATES) != STATUS_OK) return STATUS_ERROR;
    if (c->mode == INITIALIZING && component_initialise(c) != STATUS_OK) return STATUS_ERROR;
    model_derivative(&c->model, derivatives);
    return STATUS_OK;
}

int component_get_indicators(const Component *c, double indicators[], size_t n) {
    if (check_count(c, indicators, n, N_INDICATORS) != STATUS_OK) return STATUS_ERROR;
    model_indicators(&c->model, indicators);
    return STATUS_OK;
}

int component_get_nominals(const Component *c, double nominals[], size_t n) {
    if (check_count(c, nominals, n, N_STATES) != STATUS_OK) return STATUS_ERROR;
    memcpy(nominals, NOMINALS, sizeof NOMINALS);
    return STATUS_OK;
}
