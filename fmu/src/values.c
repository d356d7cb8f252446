/* Values: everything is a double in one struct; arrays lie over scalars that follow one another. */
#include "component.h"

#include <math.h>


static size_t size_of(uint32_t reference) { return reference < N_VARIABLES ? 1 : VIEWS[reference - N_VARIABLES].size; }

static uint32_t first_of(uint32_t reference) {
    return reference < N_VARIABLES ? reference : VIEWS[reference - N_VARIABLES].first;
}

static const char *name_of(uint32_t reference) {
    return reference < N_VARIABLES ? FACTS[reference].name : VIEWS[reference - N_VARIABLES].name;
}

/* Where a variable lies, and how many elements it has. */
const double *component_read(Component *c, uint32_t reference, size_t *size) {
    *size = size_of(reference);
    return (const double *)((const char *)&c->model.v + FACTS[first_of(reference)].offset);
}

void component_write(Component *c, uint32_t reference, size_t element, double value) {
    *(double *)((char *)&c->model.v + FACTS[first_of(reference) + element].offset) = value;
}

static int check_list(const Component *c, const char *function, const List *list) {
    if (list->n > 0 && (!list->references || (!list->values && list->n_values > 0)))
        return component_refuse(c, "%s: null pointer", function);
    size_t values = 0;
    for (size_t i = 0; i < list->n; i++) {
        uint32_t reference = list->references[i];
        if (reference >= N_VARIABLES + N_VIEWS)
            return component_refuse(c, "%s: no variable has value reference %u", function, reference);
        if ((int)FACTS[first_of(reference)].kind != list->kind)
            return component_refuse(c, "%s: %s is of another type", function, name_of(reference));
        values += size_of(reference);
    }
    if (values != list->n_values)
        return component_refuse(c, "%s: the variables hold %zu values, not %zu", function, values, list->n_values);
    return STATUS_OK;
}

/* Before getting: the list is right and the outputs belong to the present state and inputs. */
int component_before_get(Component *c, const char *function, const List *list) {
    if (!component_allowed(c, function, IN_ANY)) return STATUS_ERROR;
    if (check_list(c, function, list) != STATUS_OK) return STATUS_ERROR;
    bool started = c->mode == INITIALIZING || c->mode == STEPPING || c->mode == EVENT || c->mode == CONTINUOUS;
    if (!started || !c->model.outputs_stale) return STATUS_OK;
    bool outputs = false;
    for (size_t i = 0; i < list->n && !outputs; i++) {
        Causality causality = FACTS[first_of(list->references[i])].causality;
        outputs = causality == OUTPUT || causality == INDEPENDENT;
    }
    if (!outputs) return STATUS_OK;
    if (c->mode == INITIALIZING && component_initialise(c) != STATUS_OK) return STATUS_ERROR;
    model_outputs(&c->model);
    return STATUS_OK;
}

/* Before setting: the list is right and the time is. Each value is checked by component_check_value. */
int component_before_set(Component *c, const char *function, const List *list) {
    unsigned modes = IN_INSTANTIATED | IN_INITIALIZING | IN_STEPPING | IN_EVENT | IN_CONTINUOUS;
    if (!component_allowed(c, function, modes)) return STATUS_ERROR;
    if (check_list(c, function, list) != STATUS_OK) return STATUS_ERROR;
    c->model.outputs_stale = true;
    return STATUS_OK;
}

/* Whether one variable may be set now, and to this value. */
int component_check_value(const Component *c, uint32_t reference, size_t element, double value) {
    const VariableFact *fact = &FACTS[first_of(reference) + element];
    bool running = c->mode == STEPPING || c->mode == EVENT || c->mode == CONTINUOUS;
    if (fact->causality == OUTPUT || fact->causality == INDEPENDENT)
        return component_refuse(c, "%s is computed by the model and cannot be set", fact->name);
    if (fact->causality == PARAMETER && running)
        return component_refuse(c, "%s is fixed once the run has begun", fact->name);
    if (fact->kind != FLOAT64 && (c->mode == CONTINUOUS || (c->mode == STEPPING && c->event_mode)))
        return component_refuse(c, "%s is discrete and can only be set in Event Mode", fact->name);
    if (!isfinite(value)) return component_refuse(c, "%s = %g is not a finite number", fact->name, value);
    if (value < fact->minimum || value > fact->maximum)
        return component_refuse(c, "%s = %g is outside [%g, %g]", fact->name, value, fact->minimum, fact->maximum);
    return STATUS_OK;
}
