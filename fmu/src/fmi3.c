/* FMI 3.0: instances, life cycle, values, saved states, derivatives; translated to component.h. */
#include "fmi3.h"

#include <stdlib.h>

#include "component.h"

#define ALLOWED(function, modes) if (!component_allowed(instance, function, modes)) return fmi3Error

static void say(const Component *c, int status, const char *category, const char *text) {
    ((fmi3LogMessageCallback)c->logger)(c->environment, (fmi3Status)status, category, text);
}

FMI3_EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

FMI3_EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t n, const fmi3String names[]) {
    return instance ? (fmi3Status)component_log(instance, on, n, names) : fmi3Error;
}

FMI3_EXPORT fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean events, fmi3Boolean early, const fmi3ValueReference required[], size_t n_required,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
    (void)resources, (void)visible, (void)required, (void)n_required, (void)update;
    Component *c = component_new(name, token, CO_SIMULATION, logging, environment, (void (*)(void))log, say);
    if (!c) return 0;
    c->event_mode = events;
    c->early_return = early;
    return c;
}

FMI3_EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                      fmi3Boolean visible, fmi3Boolean logging,
                                                      fmi3InstanceEnvironment environment,
                                                      fmi3LogMessageCallback log) {
    (void)resources, (void)visible;
    return component_new(name, token, MODEL_EXCHANGE, logging, environment, (void (*)(void))log, say);
}

FMI3_EXPORT void fmi3FreeInstance(fmi3Instance instance) { free(instance); }

FMI3_EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean tolerance_defined,
                                                   fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean stop_defined,
                                                   fmi3Float64 stop) {
    (void)tolerance_defined, (void)tolerance;
    ALLOWED("fmi3EnterInitializationMode", IN_INSTANTIATED);
    Component *c = instance;
    if (component_set_times(c, start, stop_defined, stop) != STATUS_OK) return fmi3Error;
    c->mode = INITIALIZING;
    c->model.outputs_stale = true;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
    return (fmi3Status)component_leave_initialization(instance, "fmi3ExitInitializationMode");
}

FMI3_EXPORT fmi3Status fmi3Terminate(fmi3Instance instance) {
    ALLOWED("fmi3Terminate", IN_STEPPING | IN_EVENT | IN_CONTINUOUS);
    ((Component *)instance)->mode = TERMINATED;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3Reset(fmi3Instance instance) { return (fmi3Status)component_reset(instance); }

FMI3_EXPORT fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 point, fmi3Float64 step, fmi3Boolean no_rollback,
                                  fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last) {
    (void)no_rollback;
    ALLOWED("fmi3DoStep", IN_STEPPING);
    if (!event || !terminate || !early || !last)
        return (fmi3Status)component_refuse(instance, "fmi3DoStep: a result pointer is null");
    *event = *terminate = *early = false;
    return (fmi3Status)component_step(instance, point, step, event, early, last);
}

/* One getter and one setter per FMI type; a list is refused whole, before anything is written. */
#define ACCESS(Name, Type, kind, to_type)                                                                             \
    FMI3_EXPORT fmi3Status fmi3Get##Name(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,            \
                                         Type values[], size_t n_values) {                                            \
        List list = {refs, n, values, n_values, kind};                                                                \
        if (component_before_get(instance, "fmi3Get" #Name, &list) != STATUS_OK) return fmi3Error;                    \
        for (size_t i = 0, k = 0, size; i < n; i++) {                                                                 \
            const double *from = component_read(instance, refs[i], &size);                                            \
            for (size_t j = 0; j < size; j++) values[k++] = to_type(from[j]);                                         \
        }                                                                                                             \
        return fmi3OK;                                                                                                \
    }                                                                                                                 \
    FMI3_EXPORT fmi3Status fmi3Set##Name(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,            \
                                         const Type values[], size_t n_values) {                                      \
        List list = {refs, n, values, n_values, kind};                                                                \
        if (component_before_set(instance, "fmi3Set" #Name, &list) != STATUS_OK) return fmi3Error;                    \
        for (int writing = 0; writing < 2; writing++) {                                                               \
            for (size_t i = 0, k = 0, size; i < n; i++) {                                                             \
                component_read(instance, refs[i], &size);                                                             \
                for (size_t j = 0; j < size; j++, k++) {                                                              \
                    double value = (double)values[k];                                                                 \
                    if (writing) component_write(instance, refs[i], j, value);                                        \
                    else if (component_check_value(instance, refs[i], j, value) != STATUS_OK) return fmi3Error;       \
                }                                                                                                     \
            }                                                                                                         \
        }                                                                                                             \
        return fmi3OK;                                                                                                \
    }

#define AS_FLOAT64(x) (x)
#define AS_INT32(x) ((fmi3Int32)(x))
#define AS_BOOLEAN(x) ((x) != 0.0)
ACCESS(Float64, fmi3Float64, FLOAT64, AS_FLOAT64)
ACCESS(Int32, fmi3Int32, INT32, AS_INT32)
ACCESS(Boolean, fmi3Boolean, BOOLEAN, AS_BOOLEAN)

FMI3_EXPORT fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                                    size_t n_unknowns, const fmi3ValueReference knowns[],
                                                    size_t n_knowns, const fmi3Float64 seed[], size_t n_seed,
                                                    fmi3Float64 sensitivity[], size_t n_sensitivity) {
    const char *function = "fmi3GetDirectionalDerivative";
    ALLOWED(function, IN_INITIALIZING | IN_STEPPING | IN_EVENT | IN_CONTINUOUS);
    List to = {unknowns, n_unknowns, sensitivity, n_sensitivity, FLOAT64}, from = {knowns, n_knowns, seed, n_seed, FLOAT64};
    if (!unknowns || !knowns || !seed || !sensitivity || n_seed != n_knowns || n_sensitivity != n_unknowns)
        return (fmi3Status)component_refuse(instance, "%s: one seed per known, one sensitivity per unknown", function);
    return (fmi3Status)component_sensitivity(instance, function, &to, &from, seed, sensitivity);
}

/* Saved states. */

FMI3_EXPORT fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state) {
    ALLOWED("fmi3GetFMUState", IN_ANY);
    if (!state) return (fmi3Status)component_refuse(instance, "fmi3GetFMUState: null pointer");
    return (fmi3Status)component_save(instance, state);
}

FMI3_EXPORT fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
    ALLOWED("fmi3SetFMUState", IN_ANY);
    return (fmi3Status)component_restore(instance, state);
}

FMI3_EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state) {
    ALLOWED("fmi3FreeFMUState", IN_ANY);
    if (!state) return fmi3OK;
    free(*state);
    *state = 0;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size) {
    ALLOWED("fmi3SerializedFMUStateSize", IN_ANY);
    if (!state || !size) return (fmi3Status)component_refuse(instance, "fmi3SerializedFMUStateSize: null pointer");
    *size = component_saved_size();
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[],
                                             size_t size) {
    ALLOWED("fmi3SerializeFMUState", IN_ANY);
    return (fmi3Status)component_serialise(instance, state, bytes, size);
}

FMI3_EXPORT fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size,
                                               fmi3FMUState *state) {
    ALLOWED("fmi3DeserializeFMUState", IN_ANY);
    if (!state) return (fmi3Status)component_refuse(instance, "fmi3DeserializeFMUState: null pointer");
    return (fmi3Status)component_deserialise(instance, bytes, size, state);
}
