/* FMI 3.0: events, and Model Exchange; translated to component.h. */
#include "component.h"
#include "fmi3.h"

#define ALLOWED(function, modes) if (!component_allowed(instance, function, modes)) return fmi3Error
#define IN_RUN (IN_INITIALIZING | IN_EVENT | IN_CONTINUOUS)

/* Functions that only one of the two interfaces has. */
#define ONLY(function, wanted)                                                                                        \
    if (instance && ((Component *)instance)->interface != (wanted))                                                   \
        return (fmi3Status)component_refuse(instance, "%s belongs to the other interface", function)

static fmi3Status enter(Component *c, const char *function, unsigned from, Mode to) {
    if (!component_allowed(c, function, from)) return fmi3Error;
    c->mode = to;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
    Component *c = instance;
    if (c && c->interface == CO_SIMULATION && !c->event_mode)
        return (fmi3Status)component_refuse(c, "fmi3EnterEventMode: instantiated without eventModeUsed");
    return enter(c, "fmi3EnterEventMode", IN_STEPPING | IN_CONTINUOUS, EVENT);
}

FMI3_EXPORT fmi3Status fmi3EnterStepMode(fmi3Instance instance) {
    ONLY("fmi3EnterStepMode", CO_SIMULATION);
    return enter(instance, "fmi3EnterStepMode", IN_EVENT, STEPPING);
}

FMI3_EXPORT fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) {
    ONLY("fmi3EnterContinuousTimeMode", MODEL_EXCHANGE);
    return enter(instance, "fmi3EnterContinuousTimeMode", IN_EVENT, CONTINUOUS);
}

FMI3_EXPORT fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance) {
    ALLOWED("fmi3EvaluateDiscreteStates", IN_INITIALIZING | IN_EVENT);
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *update, fmi3Boolean *terminate,
                                                fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *defined,
                                                fmi3Float64 *time) {
    ALLOWED("fmi3UpdateDiscreteStates", IN_EVENT);
    if (!update || !terminate || !nominals || !values || !defined || !time)
        return (fmi3Status)component_refuse(instance, "fmi3UpdateDiscreteStates: a result pointer is null");
    EventInfo info;
    if (component_update(instance, &info) != STATUS_OK) return fmi3Error;
    *update = *terminate = *nominals = false;
    *values = info.states_changed;
    *defined = info.time_defined;
    *time = info.time;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean no_rollback,
                                                   fmi3Boolean *event, fmi3Boolean *terminate) {
    (void)no_rollback;
    ALLOWED("fmi3CompletedIntegratorStep", IN_CONTINUOUS);
    if (!event || !terminate)
        return (fmi3Status)component_refuse(instance, "fmi3CompletedIntegratorStep: a result pointer is null");
    *event = *terminate = false;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time) {
    ONLY("fmi3SetTime", MODEL_EXCHANGE);
    ALLOWED("fmi3SetTime", IN_EVENT | IN_CONTINUOUS);
    return (fmi3Status)component_set_time(instance, time);
}

FMI3_EXPORT fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 states[], size_t n) {
    ONLY("fmi3SetContinuousStates", MODEL_EXCHANGE);
    ALLOWED("fmi3SetContinuousStates", IN_CONTINUOUS);
    return (fmi3Status)component_set_states(instance, states, n);
}

FMI3_EXPORT fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 states[], size_t n) {
    ONLY("fmi3GetContinuousStates", MODEL_EXCHANGE);
    ALLOWED("fmi3GetContinuousStates", IN_RUN);
    return (fmi3Status)component_get_states(instance, states, n);
}

FMI3_EXPORT fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[], size_t n) {
    ONLY("fmi3GetContinuousStateDerivatives", MODEL_EXCHANGE);
    ALLOWED("fmi3GetContinuousStateDerivatives", IN_RUN);
    return (fmi3Status)component_get_derivatives(instance, derivatives, n);
}

FMI3_EXPORT fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 indicators[], size_t n) {
    ONLY("fmi3GetEventIndicators", MODEL_EXCHANGE);
    ALLOWED("fmi3GetEventIndicators", IN_RUN);
    return (fmi3Status)component_get_indicators(instance, indicators, n);
}

FMI3_EXPORT fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t n) {
    ONLY("fmi3GetNominalsOfContinuousStates", MODEL_EXCHANGE);
    ALLOWED("fmi3GetNominalsOfContinuousStates", IN_ANY);
    return (fmi3Status)component_get_nominals(instance, nominals, n);
}

FMI3_EXPORT fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *n) {
    ONLY("fmi3GetNumberOfEventIndicators", MODEL_EXCHANGE);
    ALLOWED("fmi3GetNumberOfEventIndicators", IN_ANY);
    if (!n) return (fmi3Status)component_refuse(instance, "fmi3GetNumberOfEventIndicators: null pointer");
    *n = N_INDICATORS;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *n) {
    ONLY("fmi3GetNumberOfContinuousStates", MODEL_EXCHANGE);
    ALLOWED("fmi3GetNumberOfContinuousStates", IN_ANY);
    if (!n) return (fmi3Status)component_refuse(instance, "fmi3GetNumberOfContinuousStates: null pointer");
    *n = N_STATES;
    return fmi3OK;
}
