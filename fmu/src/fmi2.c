/* FMI 2.0: instances, life cycle, values, saved states, derivatives; translated to component.h. */
#include "fmi2.h"

#include <stdlib.h>

#include "component.h"

#define ALLOWED(function, modes) if (!component_allowed(instance, function, modes)) return fmi2Error

typedef void (*Logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);

static void say(const Component *c, int status, const char *category, const char *text) {
    ((Logger)c->logger)(c->environment, c->name, (fmi2Status)status, category, "%s", text);
}

FMI2_EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
FMI2_EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

FMI2_EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component instance, fmi2Boolean on, size_t n, const fmi2String names[]) {
    return instance ? (fmi2Status)component_log(instance, on != fmi2False, n, names) : fmi2Error;
}

FMI2_EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                                          const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                                          fmi2Boolean logging) {
    (void)resources, (void)visible;
    if (type != fmi2CoSimulation && type != fmi2ModelExchange) return 0;
    Interface interface = type == fmi2CoSimulation ? CO_SIMULATION : MODEL_EXCHANGE;
    void (*logger)(void) = functions ? (void (*)(void))functions->logger : 0;
    return component_new(name, token, interface, logging != fmi2False, functions ? functions->environment : 0, logger, say);
}

FMI2_EXPORT void fmi2FreeInstance(fmi2Component instance) { free(instance); }

FMI2_EXPORT fmi2Status fmi2SetupExperiment(fmi2Component instance, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                                           fmi2Real start, fmi2Boolean stop_defined, fmi2Real stop) {
    (void)tolerance_defined, (void)tolerance;
    ALLOWED("fmi2SetupExperiment", IN_INSTANTIATED);
    return (fmi2Status)component_set_times(instance, start, stop_defined != fmi2False, stop);
}

FMI2_EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component instance) {
    ALLOWED("fmi2EnterInitializationMode", IN_INSTANTIATED);
    Component *c = instance;
    c->mode = INITIALIZING;
    c->model.outputs_stale = true;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component instance) {
    return (fmi2Status)component_leave_initialization(instance, "fmi2ExitInitializationMode");
}

FMI2_EXPORT fmi2Status fmi2Terminate(fmi2Component instance) {
    ALLOWED("fmi2Terminate", IN_STEPPING | IN_EVENT | IN_CONTINUOUS);
    ((Component *)instance)->mode = TERMINATED;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2Reset(fmi2Component instance) { return (fmi2Status)component_reset(instance); }

FMI2_EXPORT fmi2Status fmi2DoStep(fmi2Component instance, fmi2Real point, fmi2Real step, fmi2Boolean no_rollback) {
    (void)no_rollback;
    ALLOWED("fmi2DoStep", IN_STEPPING);
    bool event, early;
    double last;
    return (fmi2Status)component_step(instance, point, step, &event, &early, &last);
}

/* One getter and one setter per FMI type; a list is refused whole, before anything is written. */
#define ACCESS(Name, Type, kind, to_type)                                                                             \
    FMI2_EXPORT fmi2Status fmi2Get##Name(fmi2Component instance, const fmi2ValueReference refs[], size_t n,           \
                                         Type values[]) {                                                             \
        List list = {refs, n, values, n, kind};                                                                       \
        if (component_before_get(instance, "fmi2Get" #Name, &list) != STATUS_OK) return fmi2Error;                    \
        for (size_t i = 0, size; i < n; i++) values[i] = to_type(*component_read(instance, refs[i], &size));          \
        return fmi2OK;                                                                                                \
    }                                                                                                                 \
    FMI2_EXPORT fmi2Status fmi2Set##Name(fmi2Component instance, const fmi2ValueReference refs[], size_t n,           \
                                         const Type values[]) {                                                       \
        List list = {refs, n, values, n, kind};                                                                       \
        if (component_before_set(instance, "fmi2Set" #Name, &list) != STATUS_OK) return fmi2Error;                    \
        for (size_t i = 0; i < n; i++)                                                                                \
            if (component_check_value(instance, refs[i], 0, (double)values[i]) != STATUS_OK) return fmi2Error;        \
        for (size_t i = 0; i < n; i++) component_write(instance, refs[i], 0, (double)values[i]);                      \
        return fmi2OK;                                                                                                \
    }

#define AS_REAL(x) (x)
#define AS_INTEGER(x) ((fmi2Integer)(x))
#define AS_BOOLEAN(x) ((x) != 0.0)
ACCESS(Real, fmi2Real, FLOAT64, AS_REAL)
ACCESS(Integer, fmi2Integer, INT32, AS_INTEGER)
ACCESS(Boolean, fmi2Boolean, BOOLEAN, AS_BOOLEAN)

FMI2_EXPORT fmi2Status fmi2GetString(fmi2Component instance, const fmi2ValueReference refs[], size_t n,
                                     fmi2String values[]) {
    (void)refs, (void)values;
    if (!instance) return fmi2Error;
    return n == 0 ? fmi2OK : (fmi2Status)component_refuse(instance, "fmi2GetString: no variable of this type exists");
}

FMI2_EXPORT fmi2Status fmi2SetString(fmi2Component instance, const fmi2ValueReference refs[], size_t n,
                                     const fmi2String values[]) {
    (void)refs, (void)values;
    if (!instance) return fmi2Error;
    return n == 0 ? fmi2OK : (fmi2Status)component_refuse(instance, "fmi2SetString: no variable of this type exists");
}

FMI2_EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component instance, const fmi2ValueReference unknowns[],
                                                    size_t n_unknowns, const fmi2ValueReference knowns[],
                                                    size_t n_knowns, const fmi2Real seed[], fmi2Real sensitivity[]) {
    const char *function = "fmi2GetDirectionalDerivative";
    ALLOWED(function, IN_INITIALIZING | IN_STEPPING | IN_EVENT | IN_CONTINUOUS);
    if (!unknowns || !knowns || !seed || !sensitivity)
        return (fmi2Status)component_refuse(instance, "%s: null pointer", function);
    List to = {unknowns, n_unknowns, sensitivity, n_unknowns, FLOAT64}, from = {knowns, n_knowns, seed, n_knowns, FLOAT64};
    return (fmi2Status)component_sensitivity(instance, function, &to, &from, seed, sensitivity);
}

/* Saved states. */

FMI2_EXPORT fmi2Status fmi2GetFMUstate(fmi2Component instance, fmi2FMUstate *state) {
    ALLOWED("fmi2GetFMUstate", IN_ANY);
    if (!state) return (fmi2Status)component_refuse(instance, "fmi2GetFMUstate: null pointer");
    return (fmi2Status)component_save(instance, state);
}

FMI2_EXPORT fmi2Status fmi2SetFMUstate(fmi2Component instance, fmi2FMUstate state) {
    ALLOWED("fmi2SetFMUstate", IN_ANY);
    return (fmi2Status)component_restore(instance, state);
}

FMI2_EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component instance, fmi2FMUstate *state) {
    ALLOWED("fmi2FreeFMUstate", IN_ANY);
    if (!state) return fmi2OK;
    free(*state);
    *state = 0;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component instance, fmi2FMUstate state, size_t *size) {
    ALLOWED("fmi2SerializedFMUstateSize", IN_ANY);
    if (!state || !size) return (fmi2Status)component_refuse(instance, "fmi2SerializedFMUstateSize: null pointer");
    *size = component_saved_size();
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component instance, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    ALLOWED("fmi2SerializeFMUstate", IN_ANY);
    return (fmi2Status)component_serialise(instance, state, (unsigned char *)bytes, size);
}

FMI2_EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component instance, const fmi2Byte bytes[], size_t size,
                                               fmi2FMUstate *state) {
    ALLOWED("fmi2DeSerializeFMUstate", IN_ANY);
    if (!state) return (fmi2Status)component_refuse(instance, "fmi2DeSerializeFMUstate: null pointer");
    return (fmi2Status)component_deserialise(instance, (const unsigned char *)bytes, size, state);
}
