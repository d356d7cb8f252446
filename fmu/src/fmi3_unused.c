/* The rest of FMI 3.0: every function of the standard must be there; these have nothing to do in this model
 * and say so. Types without variables accept empty lists. */
#include "fmi3.h"

#define REFUSED(function) fmi3_refuse(instance, function, "this FMU does not offer it")
#define EMPTY(function) (n == 0 ? fmi3OK : fmi3_refuse(instance, function, "no variable of this type exists"))


/* Access to a type that no variable has. */
#define ACCESS_NONE(Name)                                                                                             \
    FMI3_EXPORT fmi3Status fmi3Get##Name(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,            \
                                         fmi3##Name values[], size_t n_values) {                                      \
        (void)refs, (void)values, (void)n_values;                                                                     \
        return EMPTY("fmi3Get" #Name);                                                                                \
    }                                                                                                                 \
    FMI3_EXPORT fmi3Status fmi3Set##Name(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,            \
                                         const fmi3##Name values[], size_t n_values) {                                \
        (void)refs, (void)values, (void)n_values;                                                                     \
        return EMPTY("fmi3Set" #Name);                                                                                \
    }

ACCESS_NONE(Float32)
ACCESS_NONE(Int8)
ACCESS_NONE(UInt8)
ACCESS_NONE(Int16)
ACCESS_NONE(UInt16)
ACCESS_NONE(UInt32)
ACCESS_NONE(Int64)
ACCESS_NONE(UInt64)
ACCESS_NONE(String)

FMI3_EXPORT fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                     size_t sizes[], fmi3Binary values[], size_t n_values) {
    (void)refs, (void)sizes, (void)values, (void)n_values;
    return EMPTY("fmi3GetBinary");
}

FMI3_EXPORT fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                     const size_t sizes[], const fmi3Binary values[], size_t n_values) {
    (void)refs, (void)sizes, (void)values, (void)n_values;
    return EMPTY("fmi3SetBinary");
}

FMI3_EXPORT fmi3Status fmi3GetClock(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                    fmi3Clock values[]) {
    (void)refs, (void)values;
    return EMPTY("fmi3GetClock");
}

FMI3_EXPORT fmi3Status fmi3SetClock(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                    const fmi3Clock values[]) {
    (void)refs, (void)values;
    return EMPTY("fmi3SetClock");
}

/* Events, configuration, clocks. */

FMI3_EXPORT fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
    return REFUSED("fmi3EnterEventMode");
}

FMI3_EXPORT fmi3Status fmi3EnterStepMode(fmi3Instance instance) {
    return REFUSED("fmi3EnterStepMode");
}

FMI3_EXPORT fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) {
    return REFUSED("fmi3EnterConfigurationMode");
}

FMI3_EXPORT fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) {
    return REFUSED("fmi3ExitConfigurationMode");
}

FMI3_EXPORT fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance) {
    return REFUSED("fmi3EvaluateDiscreteStates");
}

FMI3_EXPORT fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *update, fmi3Boolean *terminate,
                                                fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *defined,
                                                fmi3Float64 *time) {
    (void)update, (void)terminate, (void)nominals, (void)values, (void)defined, (void)time;
    return REFUSED("fmi3UpdateDiscreteStates");
}

FMI3_EXPORT fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                              fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[]) {
    (void)refs, (void)intervals, (void)qualifiers;
    return EMPTY("fmi3GetIntervalDecimal");
}

FMI3_EXPORT fmi3Status fmi3GetIntervalFraction(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                               fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                                               fmi3IntervalQualifier qualifiers[]) {
    (void)refs, (void)counters, (void)resolutions, (void)qualifiers;
    return EMPTY("fmi3GetIntervalFraction");
}

FMI3_EXPORT fmi3Status fmi3GetShiftDecimal(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                           fmi3Float64 shifts[]) {
    (void)refs, (void)shifts;
    return EMPTY("fmi3GetShiftDecimal");
}

FMI3_EXPORT fmi3Status fmi3GetShiftFraction(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                            fmi3UInt64 counters[], fmi3UInt64 resolutions[]) {
    (void)refs, (void)counters, (void)resolutions;
    return EMPTY("fmi3GetShiftFraction");
}

FMI3_EXPORT fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                              const fmi3Float64 intervals[]) {
    (void)refs, (void)intervals;
    return EMPTY("fmi3SetIntervalDecimal");
}

FMI3_EXPORT fmi3Status fmi3SetIntervalFraction(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                               const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
    (void)refs, (void)counters, (void)resolutions;
    return EMPTY("fmi3SetIntervalFraction");
}

FMI3_EXPORT fmi3Status fmi3SetShiftDecimal(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                           const fmi3Float64 shifts[]) {
    (void)refs, (void)shifts;
    return EMPTY("fmi3SetShiftDecimal");
}

FMI3_EXPORT fmi3Status fmi3SetShiftFraction(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                            const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
    (void)refs, (void)counters, (void)resolutions;
    return EMPTY("fmi3SetShiftFraction");
}

/* Dependencies, derivatives, saved states. */

FMI3_EXPORT fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance, fmi3ValueReference reference,
                                                           size_t *n) {
    (void)reference, (void)n;
    return REFUSED("fmi3GetNumberOfVariableDependencies");
}

FMI3_EXPORT fmi3Status fmi3GetVariableDependencies(fmi3Instance instance, fmi3ValueReference dependent,
                                                   size_t rows[], fmi3ValueReference independents[],
                                                   size_t columns[], fmi3DependencyKind kinds[], size_t n) {
    (void)dependent, (void)rows, (void)independents, (void)columns, (void)kinds, (void)n;
    return REFUSED("fmi3GetVariableDependencies");
}

FMI3_EXPORT fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                                    size_t n_unknowns, const fmi3ValueReference knowns[],
                                                    size_t n_knowns, const fmi3Float64 seed[], size_t n_seed,
                                                    fmi3Float64 sensitivity[], size_t n_sensitivity) {
    (void)unknowns, (void)n_unknowns, (void)knowns, (void)n_knowns, (void)seed, (void)n_seed, (void)sensitivity, (void)n_sensitivity;
    return REFUSED("fmi3GetDirectionalDerivative");
}

FMI3_EXPORT fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                                size_t n_unknowns, const fmi3ValueReference knowns[],
                                                size_t n_knowns, const fmi3Float64 seed[], size_t n_seed,
                                                fmi3Float64 sensitivity[], size_t n_sensitivity) {
    (void)unknowns, (void)n_unknowns, (void)knowns, (void)n_knowns, (void)seed, (void)n_seed, (void)sensitivity, (void)n_sensitivity;
    return REFUSED("fmi3GetAdjointDerivative");
}

FMI3_EXPORT fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                                const fmi3Int32 orders[], fmi3Float64 values[], size_t n_values) {
    (void)refs, (void)orders, (void)values, (void)n_values;
    return EMPTY("fmi3GetOutputDerivatives");
}

FMI3_EXPORT fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state) {
    (void)state;
    return REFUSED("fmi3GetFMUState");
}

FMI3_EXPORT fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
    (void)state;
    return REFUSED("fmi3SetFMUState");
}

FMI3_EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state) {
    (void)state;
    return REFUSED("fmi3FreeFMUState");
}

FMI3_EXPORT fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size) {
    (void)state, (void)size;
    return REFUSED("fmi3SerializedFMUStateSize");
}

FMI3_EXPORT fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[],
                                             size_t size) {
    (void)state, (void)bytes, (void)size;
    return REFUSED("fmi3SerializeFMUState");
}

FMI3_EXPORT fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size,
                                               fmi3FMUState *state) {
    (void)bytes, (void)size, (void)state;
    return REFUSED("fmi3DeserializeFMUState");
}

/* Model Exchange. */

FMI3_EXPORT fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) {
    return REFUSED("fmi3EnterContinuousTimeMode");
}

FMI3_EXPORT fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean no_rollback,
                                                   fmi3Boolean *event, fmi3Boolean *terminate) {
    (void)no_rollback, (void)event, (void)terminate;
    return REFUSED("fmi3CompletedIntegratorStep");
}

FMI3_EXPORT fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time) {
    (void)time;
    return REFUSED("fmi3SetTime");
}

FMI3_EXPORT fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 states[], size_t n) {
    (void)states, (void)n;
    return REFUSED("fmi3SetContinuousStates");
}

FMI3_EXPORT fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 states[], size_t n) {
    (void)states, (void)n;
    return REFUSED("fmi3GetContinuousStates");
}

FMI3_EXPORT fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[], size_t n) {
    (void)derivatives, (void)n;
    return REFUSED("fmi3GetContinuousStateDerivatives");
}

FMI3_EXPORT fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 indicators[], size_t n) {
    (void)indicators, (void)n;
    return REFUSED("fmi3GetEventIndicators");
}

FMI3_EXPORT fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t n) {
    (void)nominals, (void)n;
    return REFUSED("fmi3GetNominalsOfContinuousStates");
}

FMI3_EXPORT fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *n) {
    (void)n;
    return REFUSED("fmi3GetNumberOfEventIndicators");
}

FMI3_EXPORT fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *n) {
    (void)n;
    return REFUSED("fmi3GetNumberOfContinuousStates");
}

/* Scheduled Execution. */

FMI3_EXPORT fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference clock, fmi3Float64 time) {
    (void)clock, (void)time;
    return REFUSED("fmi3ActivateModelPartition");
}

/* Interfaces that the model does not have: no instance. */

FMI3_EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                      fmi3Boolean visible, fmi3Boolean logging,
                                                      fmi3InstanceEnvironment environment,
                                                      fmi3LogMessageCallback log) {
    (void)name, (void)token, (void)resources, (void)visible;
    if (log && logging) log(environment, fmi3Error, "logStatusError", "this FMU is for Co-Simulation only");
    return 0;
}

FMI3_EXPORT fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3ClockUpdateCallback update,
    fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock) {
    (void)name, (void)token, (void)resources, (void)visible, (void)update, (void)lock, (void)unlock;
    if (log && logging) log(environment, fmi3Error, "logStatusError", "this FMU is for Co-Simulation only");
    return 0;
}
