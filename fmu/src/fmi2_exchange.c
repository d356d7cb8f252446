/* FMI 2.0: events, Model Exchange, and the parts of Co-Simulation that the model has no use for. */
#include "component.h"
#include "fmi2.h"

#define ALLOWED(function, modes) if (!component_allowed(instance, function, modes)) return fmi2Error
#define IN_RUN (IN_INITIALIZING | IN_EVENT | IN_CONTINUOUS)

/* Functions of Model Exchange. */
#define EXCHANGE(function, modes)                                                                                     \
    if (instance && ((Component *)instance)->interface != MODEL_EXCHANGE)                                             \
        return (fmi2Status)component_refuse(instance, "%s belongs to Model Exchange", function);                      \
    ALLOWED(function, modes)

FMI2_EXPORT fmi2Status fmi2EnterEventMode(fmi2Component instance) {
    EXCHANGE("fmi2EnterEventMode", IN_CONTINUOUS);
    ((Component *)instance)->mode = EVENT;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2EnterContinuousTimeMode(fmi2Component instance) {
    EXCHANGE("fmi2EnterContinuousTimeMode", IN_EVENT);
    ((Component *)instance)->mode = CONTINUOUS;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2NewDiscreteStates(fmi2Component instance, fmi2EventInfo *info) {
    EXCHANGE("fmi2NewDiscreteStates", IN_EVENT);
    if (!info) return (fmi2Status)component_refuse(instance, "fmi2NewDiscreteStates: null pointer");
    EventInfo event;
    if (component_update(instance, &event) != STATUS_OK) return fmi2Error;
    info->newDiscreteStatesNeeded = info->terminateSimulation = info->nominalsOfContinuousStatesChanged = fmi2False;
    info->valuesOfContinuousStatesChanged = event.states_changed;
    info->nextEventTimeDefined = event.time_defined;
    info->nextEventTime = event.time;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2CompletedIntegratorStep(fmi2Component instance, fmi2Boolean no_rollback,
                                                   fmi2Boolean *event, fmi2Boolean *terminate) {
    (void)no_rollback;
    EXCHANGE("fmi2CompletedIntegratorStep", IN_CONTINUOUS);
    if (!event || !terminate)
        return (fmi2Status)component_refuse(instance, "fmi2CompletedIntegratorStep: a result pointer is null");
    *event = *terminate = fmi2False;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SetTime(fmi2Component instance, fmi2Real time) {
    EXCHANGE("fmi2SetTime", IN_EVENT | IN_CONTINUOUS);
    return (fmi2Status)component_set_time(instance, time);
}

FMI2_EXPORT fmi2Status fmi2SetContinuousStates(fmi2Component instance, const fmi2Real states[], size_t n) {
    EXCHANGE("fmi2SetContinuousStates", IN_CONTINUOUS);
    return (fmi2Status)component_set_states(instance, states, n);
}

FMI2_EXPORT fmi2Status fmi2GetContinuousStates(fmi2Component instance, fmi2Real states[], size_t n) {
    EXCHANGE("fmi2GetContinuousStates", IN_RUN);
    return (fmi2Status)component_get_states(instance, states, n);
}

FMI2_EXPORT fmi2Status fmi2GetDerivatives(fmi2Component instance, fmi2Real derivatives[], size_t n) {
    EXCHANGE("fmi2GetDerivatives", IN_RUN);
    return (fmi2Status)component_get_derivatives(instance, derivatives, n);
}

FMI2_EXPORT fmi2Status fmi2GetEventIndicators(fmi2Component instance, fmi2Real indicators[], size_t n) {
    EXCHANGE("fmi2GetEventIndicators", IN_RUN);
    return (fmi2Status)component_get_indicators(instance, indicators, n);
}

FMI2_EXPORT fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component instance, fmi2Real nominals[], size_t n) {
    EXCHANGE("fmi2GetNominalsOfContinuousStates", IN_ANY);
    return (fmi2Status)component_get_nominals(instance, nominals, n);
}

/* Steps are done when fmi2DoStep returns; there are no input derivatives. */

#define REFUSED(function) (instance ? (fmi2Status)component_refuse(instance, "%s: not offered", function) : fmi2Error)

FMI2_EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component instance, const fmi2ValueReference refs[], size_t n,
                                                   const fmi2Integer orders[], const fmi2Real values[]) {
    (void)refs, (void)orders, (void)values;
    return instance && n == 0 ? fmi2OK : REFUSED("fmi2SetRealInputDerivatives");
}

FMI2_EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component instance, const fmi2ValueReference refs[], size_t n,
                                                    const fmi2Integer orders[], fmi2Real values[]) {
    (void)refs, (void)orders, (void)values;
    return instance && n == 0 ? fmi2OK : REFUSED("fmi2GetRealOutputDerivatives");
}

FMI2_EXPORT fmi2Status fmi2CancelStep(fmi2Component instance) { return REFUSED("fmi2CancelStep"); }

FMI2_EXPORT fmi2Status fmi2GetStatus(fmi2Component instance, fmi2StatusKind kind, fmi2Status *value) {
    (void)kind, (void)value;
    return REFUSED("fmi2GetStatus");
}

FMI2_EXPORT fmi2Status fmi2GetRealStatus(fmi2Component instance, fmi2StatusKind kind, fmi2Real *value) {
    Component *c = instance;
    if (!c || kind != fmi2LastSuccessfulTime || !value) return REFUSED("fmi2GetRealStatus");
    *value = c->start_time + (double)c->model.now / 1e9;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component instance, fmi2StatusKind kind, fmi2Integer *value) {
    (void)kind, (void)value;
    return REFUSED("fmi2GetIntegerStatus");
}

FMI2_EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component instance, fmi2StatusKind kind, fmi2Boolean *value) {
    Component *c = instance;
    if (!c || kind != fmi2Terminated || !value) return REFUSED("fmi2GetBooleanStatus");
    *value = c->mode == FAILED || c->mode == TERMINATED;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetStringStatus(fmi2Component instance, fmi2StatusKind kind, fmi2String *value) {
    (void)kind, (void)value;
    return REFUSED("fmi2GetStringStatus");
}
