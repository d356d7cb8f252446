/* The rest of FMI 3.0: every function of the standard must be there; these have nothing to do in this model
 * and say so. Types without variables accept empty lists. */
#include "component.h"
#include "fmi3.h"

static fmi3Status refused(fmi3Instance instance, const char *function, const char *reason) {
    return instance ? (fmi3Status)component_refuse(instance, "%s: %s", function, reason) : fmi3Error;
}

#define REFUSED(function) refused(instance, function, "this FMU does not offer it")
#define EMPTY(function) (n == 0 && instance ? fmi3OK : refused(instance, function, "no variable of this type exists"))

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

/* Configuration, clocks. */

FMI3_EXPORT fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) {
    return REFUSED("fmi3EnterConfigurationMode");
}

FMI3_EXPORT fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) {
    return REFUSED("fmi3ExitConfigurationMode");
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

/* Dependencies and other derivatives. */

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

/* Scheduled Execution. */

FMI3_EXPORT fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference clock, fmi3Float64 time) {
    (void)clock, (void)time;
    return REFUSED("fmi3ActivateModelPartition");
}

/* An interface that the model does not have: no instance. */

FMI3_EXPORT fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3ClockUpdateCallback update,
    fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock) {
    (void)name, (void)token, (void)resources, (void)visible, (void)update, (void)lock, (void)unlock;
    if (log && logging) log(environment, fmi3Error, "logStatusError", "this FMU is for Co-Simulation and Model Exchange");
    return 0;
}
