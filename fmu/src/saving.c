/* Saved states. The model is plain data without pointers, so a state is a copy of it, and a restored run goes on
 * with the same bits, in this instance or in another of the same library. */
#include "component.h"

#include <stdlib.h>
#include <string.h>

#define MAGIC "Sidestep state 1"

typedef struct {
    char magic[16];
    char token[40];
    uint64_t checksum;  /* of all that follows */
    Model model;
    double start_time, stop_time;
    int32_t mode, interface, stop_defined, event_mode;
} Saved;

/* FNV-1a. */
static uint64_t checksum(const Saved *saved) {
    const unsigned char *bytes = (const unsigned char *)&saved->model, *end = (const unsigned char *)(saved + 1);
    uint64_t hash = UINT64_C(14695981039346656037);
    while (bytes < end) hash = (hash ^ *bytes++) * UINT64_C(1099511628211);
    return hash;
}

/* Whether this is a state of this model, unharmed, for this kind of instance. */
static int check(const Component *c, const Saved *saved) {
    if (memcmp(saved->magic, MAGIC, sizeof saved->magic) != 0 || strncmp(saved->token, MODEL_TOKEN, 40) != 0)
        return component_refuse(c, "this is not a state of this model");
    if (saved->checksum != checksum(saved)) return component_refuse(c, "the saved state is damaged");
    if (saved->mode < 0 || saved->mode >= N_MODES || saved->interface != (int32_t)c->interface
        || saved->event_mode != (int32_t)c->event_mode)
        return component_refuse(c, "the saved state belongs to another kind of instance");
    return STATUS_OK;
}

/* Into *saved; memory that is there already is used again. */
int component_save(Component *c, void **state) {
    Saved *saved = *state ? *state : calloc(1, sizeof *saved);
    if (!saved) return component_refuse(c, "no memory for a saved state");
    memset(saved, 0, sizeof *saved);
    memcpy(saved->magic, MAGIC, sizeof saved->magic);
    memcpy(saved->token, MODEL_TOKEN, strlen(MODEL_TOKEN) < 40 ? strlen(MODEL_TOKEN) : 40);
    memcpy(&saved->model, &c->model, sizeof c->model);
    saved->start_time = c->start_time;
    saved->stop_time = c->stop_time;
    saved->mode = (int32_t)c->mode;
    saved->interface = (int32_t)c->interface;
    saved->stop_defined = c->stop_defined;
    saved->event_mode = c->event_mode;
    saved->checksum = checksum(saved);
    *state = saved;
    return STATUS_OK;
}

int component_restore(Component *c, const void *state) {
    const Saved *saved = state;
    if (!saved) return component_refuse(c, "the saved state is a null pointer");
    if (check(c, saved) != STATUS_OK) return STATUS_ERROR;
    memcpy(&c->model, &saved->model, sizeof c->model);
    c->start_time = saved->start_time;
    c->stop_time = saved->stop_time;
    c->mode = (Mode)saved->mode;
    c->stop_defined = saved->stop_defined != 0;
    return STATUS_OK;
}

size_t component_saved_size(void) { return sizeof(Saved); }

int component_serialise(const Component *c, const void *state, unsigned char bytes[], size_t size) {
    if (!state || !bytes || size < sizeof(Saved))
        return component_refuse(c, "a saved state takes %zu bytes, not %zu", sizeof(Saved), size);
    memcpy(bytes, state, sizeof(Saved));
    return STATUS_OK;
}

int component_deserialise(const Component *c, const unsigned char bytes[], size_t size, void **state) {
    if (!bytes || size != sizeof(Saved))
        return component_refuse(c, "a saved state has %zu bytes, not %zu", sizeof(Saved), size);
    Saved *saved = malloc(sizeof *saved);
    if (!saved) return component_refuse(c, "no memory for a saved state");
    memcpy(saved, bytes, sizeof *saved);
    if (check(c, saved) != STATUS_OK) {
        free(saved);
        return STATUS_ERROR;
    }
    *state = saved;
    return STATUS_OK;
}
