/* Directional derivatives: central differences of order four on a copy of the model.
 *
 * The step is a thousandth of the nominal size of what is varied: where the model is smooth, truncation and rounding
 * both stay near 1e-11 of the result. At a limit of an actuator or of the lift data the derivative is the mean of
 * both sides. What is sampled (guidance, turbulence) is held, as it is between events. */
#include "component.h"

#include <math.h>


#define RELATIVE_STEP 1e-3

/* Place in the state vector of a variable that is a continuous state; -1 if it is none. */
static int state_index(uint32_t reference) {
    for (int i = 0; i < N_STATES; i++)
        if (STATE_REFERENCES[i] == reference) return i;
    return -1;
}

static int check(Component *c, const char *function, const List *unknowns, const List *knowns) {
    bool parameters = c->mode == INITIALIZING;
    for (size_t i = 0; i < unknowns->n; i++) {
        uint32_t r = unknowns->references[i];
        if (r >= N_VARIABLES || FACTS[r].causality != OUTPUT || FACTS[r].kind != FLOAT64)
            return component_refuse(c, "%s: unknown %u is no real output", function, r);
    }
    for (size_t i = 0; i < knowns->n; i++) {
        uint32_t r = knowns->references[i];
        bool known = r < N_VARIABLES && FACTS[r].kind == FLOAT64
            && (FACTS[r].causality == INPUT || (parameters && FACTS[r].causality == PARAMETER)
                || (!parameters && !is_kinematic(&c->model) && state_index(r) >= 0));
        if (!known) return component_refuse(c, "%s: known %u is neither a real input nor a continuous state", function, r);
    }
    return STATUS_OK;
}

/* Outputs of a copy of the model that is moved by `step` along the seed. */
static const char *outputs_beside(const Component *c, Model *copy, const List *knowns, const double seed[], double step) {
    *copy = c->model;
    for (size_t i = 0; i < knowns->n; i++) {
        uint32_t r = knowns->references[i];
        int state = FACTS[r].causality == OUTPUT ? state_index(r) : -1;
        double *value = state >= 0 ? copy->x + state : (double *)((char *)&copy->v + FACTS[r].offset);
        *value += step * seed[i];
    }
    const char *wrong = c->mode == INITIALIZING ? model_initialise(copy, c->start_time) : 0;
    if (!wrong) model_outputs(copy);
    return wrong;
}

int component_sensitivity(Component *c, const char *function, const List *unknowns, const List *knowns,
                          const double seed[], double sensitivity[]) {
    static const double POINTS[4] = {1.0, -1.0, 2.0, -2.0};
    static const double WEIGHTS[4] = {8.0 / 12.0, -8.0 / 12.0, -1.0 / 12.0, 1.0 / 12.0};
    if (check(c, function, unknowns, knowns) != STATUS_OK) return STATUS_ERROR;
    double largest = 0.0;
    for (size_t i = 0; i < knowns->n; i++) {
        if (!isfinite(seed[i])) return component_refuse(c, "%s: a seed is not a finite number", function);
        double size = fabs(seed[i]) / FACTS[knowns->references[i]].nominal;
        if (size > largest) largest = size;
    }
    for (size_t k = 0; k < unknowns->n; k++) sensitivity[k] = 0.0;
    if (largest == 0.0) return STATUS_OK;
    double step = RELATIVE_STEP / largest;
    for (int point = 0; point < 4; point++) {
        Model beside;
        const char *wrong = outputs_beside(c, &beside, knowns, seed, POINTS[point] * step);
        if (wrong) return component_refuse(c, "%s: %s", function, wrong);
        for (size_t k = 0; k < unknowns->n; k++) {
            const char *base = (const char *)&beside.v;
            double value = *(const double *)(base + FACTS[unknowns->references[k]].offset);
            sensitivity[k] += WEIGHTS[point] / step * value;
        }
    }
    return STATUS_OK;
}
