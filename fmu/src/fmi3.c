/* FMI 3.0 Co-Simulation: life cycle, values, steps. A wrong call or value is refused with a message and
 * changes nothing. No globals; any number of instances. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi3.h"
#define VARIABLE_FACTS
#include "model.h"

typedef enum { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED, FAILED } Phase;
static const char *const PHASES[] = {"Instantiated", "Initialization Mode", "Step Mode", "Terminated", "failed"};
enum { IN_INSTANTIATED = 1, IN_INITIALIZING = 2, IN_STEPPING = 4, IN_TERMINATED = 8, IN_FAILED = 16 };

#define LONGEST_STEP 3600.0

typedef struct {
    Model model;
    Phase phase;
    bool logging;
    bool stop_defined;
    double start_time, stop_time;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
    char name[128];
} Instance;

static fmi3Status refuse(const Instance *s, const char *format, ...) {
    if (s->log && s->logging) {
        char text[512];
        int used = snprintf(text, sizeof text, "%s: ", s->name);
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(text + used, sizeof text - (size_t)used, format, arguments);
        va_end(arguments);
        s->log(s->environment, fmi3Error, "logStatusError", text);
    }
    return fmi3Error;
}

fmi3Status fmi3_refuse(fmi3Instance instance, const char *function, const char *reason) {
    return instance ? refuse(instance, "%s: %s", function, reason) : fmi3Error;
}

/* Whether a function may be called now. */
static bool allowed(const Instance *s, const char *function, unsigned phases) {
    if (!s) return false;
    if (phases & (1u << s->phase)) return true;
    refuse(s, "%s must not be called in state \"%s\"", function, PHASES[s->phase]);
    return false;
}

FMI3_EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

FMI3_EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t n, const fmi3String names[]) {
    Instance *s = instance;
    if (!s) return fmi3Error;
    for (size_t i = 0; i < n; i++) {
        if (!names || !names[i] || strcmp(names[i], "logStatusError") != 0)
            return refuse(s, "fmi3SetDebugLogging: unknown log category \"%s\"", names && names[i] ? names[i] : "");
    }
    s->logging = on;
    return fmi3OK;
}

FMI3_EXPORT fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean events, fmi3Boolean early, const fmi3ValueReference required[], size_t n_required,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
    (void)resources, (void)visible, (void)events, (void)early, (void)required, (void)n_required, (void)update;
    Instance *s = calloc(1, sizeof *s);
    if (!s) return 0;
    s->environment = environment;
    s->log = log;
    s->logging = logging;
    snprintf(s->name, sizeof s->name, "%s", name ? name : "");
    if (!token || strcmp(token, MODEL_TOKEN) != 0) {
        refuse(s, "instantiation token \"%s\" is not this model's %s", token ? token : "", MODEL_TOKEN);
        free(s);
        return 0;
    }
    model_defaults(&s->model);
    return s;
}

FMI3_EXPORT void fmi3FreeInstance(fmi3Instance instance) { free(instance); }

FMI3_EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean tolerance_defined,
                                                   fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean stop_defined,
                                                   fmi3Float64 stop) {
    (void)tolerance_defined, (void)tolerance;
    Instance *s = instance;
    if (!allowed(s, "fmi3EnterInitializationMode", IN_INSTANTIATED)) return fmi3Error;
    if (!isfinite(start) || fabs(start) > 1e9) return refuse(s, "startTime = %g is not a usable time", start);
    if (stop_defined && !(stop >= start && isfinite(stop)))
        return refuse(s, "stopTime = %g is not after startTime = %g", stop, start);
    s->start_time = start;
    s->stop_defined = stop_defined;
    s->stop_time = stop;
    s->phase = INITIALIZING;
    s->model.outputs_stale = true;
    return fmi3OK;
}

/* Initial state from the parameters as they are now; called for outputs in Initialization Mode as well. */
static fmi3Status initialise(Instance *s) {
    const char *wrong = model_initialise(&s->model, s->start_time);
    return wrong ? refuse(s, "%s", wrong) : fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
    Instance *s = instance;
    if (!allowed(s, "fmi3ExitInitializationMode", IN_INITIALIZING)) return fmi3Error;
    fmi3Status status = initialise(s);
    if (status == fmi3OK) s->phase = STEPPING;
    return status;
}

FMI3_EXPORT fmi3Status fmi3Terminate(fmi3Instance instance) {
    Instance *s = instance;
    if (!allowed(s, "fmi3Terminate", IN_STEPPING)) return fmi3Error;
    s->phase = TERMINATED;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3Reset(fmi3Instance instance) {
    Instance *s = instance;
    if (!s) return fmi3Error;
    model_defaults(&s->model);
    s->phase = INSTANTIATED;
    s->stop_defined = false;
    return fmi3OK;
}

FMI3_EXPORT fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 point, fmi3Float64 step, fmi3Boolean no_rollback,
                                  fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last) {
    (void)no_rollback;
    Instance *s = instance;
    if (!allowed(s, "fmi3DoStep", IN_STEPPING)) return fmi3Error;
    if (!event || !terminate || !early || !last) return refuse(s, "fmi3DoStep: a result pointer is null");
    Model *m = &s->model;
    double now = s->start_time + (double)m->now / 1e9;
    if (!(step > 0.0 && step <= LONGEST_STEP))
        return refuse(s, "communicationStepSize = %g s is outside (0, %g]", step, LONGEST_STEP);
    if (!(fabs(point - now) <= 2e-9 + 1e-12 * fabs(now)))
        return refuse(s, "currentCommunicationPoint = %.12g s, but the model is at %.12g s", point, now);
    if (s->stop_defined && point + step > s->stop_time + 1e-9)
        return refuse(s, "the step from %g s by %g s goes beyond stopTime = %g s", point, step, s->stop_time);
    *event = *terminate = *early = false;
    int64_t until = (int64_t)llround((point - s->start_time + step) * 1e9);
    const char *wrong = model_advance(m, until);
    *last = s->start_time + (double)m->now / 1e9;
    if (!wrong) return fmi3OK;
    s->phase = FAILED;
    return refuse(s, "at t = %.9g s %s", *last, wrong);
}

/* Values: everything is a double in the struct, at the offset its fact tells. */

static double *value_of(Instance *s, fmi3ValueReference reference) {
    return (double *)((char *)&s->model.v + FACTS[reference].offset);
}

static fmi3Status check_list(const Instance *s, const char *function, const fmi3ValueReference refs[], size_t n,
                             const void *values, size_t n_values, Kind kind) {
    if (n != n_values) return refuse(s, "%s: %zu value references, but %zu values", function, n, n_values);
    if (n > 0 && (!refs || !values)) return refuse(s, "%s: null pointer", function);
    for (size_t i = 0; i < n; i++) {
        if (refs[i] >= N_VARIABLES) return refuse(s, "%s: no variable has value reference %u", function, refs[i]);
        if (FACTS[refs[i]].kind != kind) return refuse(s, "%s: %s is of another type", function, FACTS[refs[i]].name);
    }
    return fmi3OK;
}

/* Before getting: the list is right and the outputs belong to the present state and inputs. */
static fmi3Status before_get(Instance *s, const char *function, const fmi3ValueReference refs[], size_t n,
                             const void *values, size_t n_values, Kind kind) {
    if (!allowed(s, function, IN_INSTANTIATED | IN_INITIALIZING | IN_STEPPING | IN_TERMINATED | IN_FAILED))
        return fmi3Error;
    if (check_list(s, function, refs, n, values, n_values, kind) != fmi3OK) return fmi3Error;
    bool started = s->phase == INITIALIZING || s->phase == STEPPING;
    if (!started || !s->model.outputs_stale) return fmi3OK;
    bool outputs = false;
    for (size_t i = 0; i < n && !outputs; i++) outputs = FACTS[refs[i]].causality == OUTPUT || refs[i] == 0;
    if (!outputs) return fmi3OK;
    if (s->phase == INITIALIZING && initialise(s) != fmi3OK) return fmi3Error;
    model_outputs(&s->model);
    return fmi3OK;
}

/* Whether one variable may be set now, and to this value. */
static fmi3Status check_set(const Instance *s, fmi3ValueReference reference, double value) {
    const VariableFact *fact = &FACTS[reference];
    if (fact->causality == OUTPUT || fact->causality == INDEPENDENT)
        return refuse(s, "%s is computed by the model and cannot be set", fact->name);
    if (fact->causality == PARAMETER && s->phase == STEPPING)
        return refuse(s, "%s is fixed once the run has begun", fact->name);
    if (!isfinite(value)) return refuse(s, "%s = %g is not a finite number", fact->name, value);
    if (value < fact->minimum || value > fact->maximum)
        return refuse(s, "%s = %g is outside [%g, %g]", fact->name, value, fact->minimum, fact->maximum);
    return fmi3OK;
}

static fmi3Status before_set(const Instance *s, const char *function, const fmi3ValueReference refs[], size_t n,
                             const void *values, size_t n_values, Kind kind) {
    if (!allowed(s, function, IN_INSTANTIATED | IN_INITIALIZING | IN_STEPPING)) return fmi3Error;
    return check_list(s, function, refs, n, values, n_values, kind);
}

/* One getter and one setter per FMI type; a list is refused whole, before anything is written. */
#define ACCESS(Name, Type, kind, to_type)                                                                             \
    FMI3_EXPORT fmi3Status fmi3Get##Name(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,            \
                                         Type values[], size_t n_values) {                                            \
        Instance *s = instance;                                                                                       \
        if (before_get(s, "fmi3Get" #Name, refs, n, values, n_values, kind) != fmi3OK) return fmi3Error;              \
        for (size_t i = 0; i < n; i++) values[i] = to_type(*value_of(s, refs[i]));                                    \
        return fmi3OK;                                                                                                \
    }                                                                                                                 \
    FMI3_EXPORT fmi3Status fmi3Set##Name(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,            \
                                         const Type values[], size_t n_values) {                                      \
        Instance *s = instance;                                                                                       \
        if (before_set(s, "fmi3Set" #Name, refs, n, values, n_values, kind) != fmi3OK) return fmi3Error;              \
        for (size_t i = 0; i < n; i++)                                                                                \
            if (check_set(s, refs[i], (double)values[i]) != fmi3OK) return fmi3Error;                                 \
        for (size_t i = 0; i < n; i++) *value_of(s, refs[i]) = (double)values[i];                                     \
        s->model.outputs_stale = true;                                                                                \
        return fmi3OK;                                                                                                \
    }

#define AS_FLOAT64(x) (x)
#define AS_INT32(x) ((fmi3Int32)(x))
#define AS_BOOLEAN(x) ((x) != 0.0)
ACCESS(Float64, fmi3Float64, FLOAT64, AS_FLOAT64)
ACCESS(Int32, fmi3Int32, INT32, AS_INT32)
ACCESS(Boolean, fmi3Boolean, BOOLEAN, AS_BOOLEAN)
