/* One instance behind either version of FMI: its life cycle, checks, values, saved states.
 * fmi2.c and fmi3.c only translate. Every wrong call or value is refused with a message and changes nothing. */
#ifndef SIDESTEP_COMPONENT_H
#define SIDESTEP_COMPONENT_H

#include "model.h"

#if defined(__GNUC__)
#pragma GCC visibility push(hidden) /* only the functions of FMI leave the library */
#endif

/* Status values that both versions of FMI share. */
enum { STATUS_OK, STATUS_WARNING, STATUS_DISCARD, STATUS_ERROR };

typedef enum { CO_SIMULATION, MODEL_EXCHANGE } Interface;

typedef enum {
    INSTANTIATED, INITIALIZING, STEPPING, EVENT, CONTINUOUS, TERMINATED, FAILED, N_MODES
} Mode;

enum {
    IN_INSTANTIATED = 1 << INSTANTIATED, IN_INITIALIZING = 1 << INITIALIZING, IN_STEPPING = 1 << STEPPING,
    IN_EVENT = 1 << EVENT, IN_CONTINUOUS = 1 << CONTINUOUS, IN_TERMINATED = 1 << TERMINATED, IN_FAILED = 1 << FAILED,
    IN_ANY = (1 << N_MODES) - 1
};

enum { LOG_ERROR, LOG_EVENTS, N_CATEGORIES };

typedef struct Component Component;
typedef void (*Say)(const Component *c, int status, const char *category, const char *text);

struct Component {
    Model model;
    Mode mode;
    Interface interface;
    bool event_mode;          /* Co-Simulation stops at events and lets the importer handle them */
    bool early_return;        /* Co-Simulation may end a step at an event */
    bool stop_defined;
    double start_time, stop_time;
    bool logging[N_CATEGORIES];
    void *environment;
    Say say;
    void (*logger)(void);     /* the importer's callback, of the version's own type */
    char name[128];
};

/* What an importer learns at an event. */
typedef struct {
    bool states_changed, time_defined;
    double time;
} EventInfo;

/* A list of variables with the values to be got or set. */
typedef struct {
    const uint32_t *references;
    size_t n;
    const void *values;
    size_t n_values;
    int kind;
} List;

/* component.c */
Component *component_new(const char *name, const char *token, Interface interface, bool logging, void *environment,
                         void (*logger)(void), Say say);
int component_refuse(const Component *c, const char *format, ...);
bool component_allowed(const Component *c, const char *function, unsigned modes);
int component_log(Component *c, bool on, size_t n, const char *const categories[]);
int component_set_times(Component *c, double start, bool stop_defined, double stop);
int component_initialise(Component *c);
int component_leave_initialization(Component *c, const char *function);
int component_reset(Component *c);
int component_step(Component *c, double point, double step, bool *event, bool *early, double *last);
void component_tell_events(Component *c);

/* exchange.c */
int component_update(Component *c, EventInfo *info);
int component_set_time(Component *c, double time);
int component_get_states(const Component *c, double states[], size_t n);
int component_set_states(Component *c, const double states[], size_t n);
int component_get_derivatives(Component *c, double derivatives[], size_t n);
int component_get_indicators(const Component *c, double indicators[], size_t n);
int component_get_nominals(const Component *c, double nominals[], size_t n);

/* values.c */
const double *component_read(Component *c, uint32_t reference, size_t *size);
int component_before_get(Component *c, const char *function, const List *list);
int component_before_set(Component *c, const char *function, const List *list);
int component_check_value(const Component *c, uint32_t reference, size_t element, double value);
void component_write(Component *c, uint32_t reference, size_t element, double value);

/* sensitivity.c */
int component_sensitivity(Component *c, const char *function, const List *unknowns, const List *knowns,
                          const double seed[], double sensitivity[]);

/* saving.c */
int component_save(Component *c, void **saved);
int component_restore(Component *c, const void *saved);
size_t component_saved_size(void);
int component_serialise(const Component *c, const void *saved, unsigned char bytes[], size_t size);
int component_deserialise(const Component *c, const unsigned char bytes[], size_t size, void **saved);

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#endif
