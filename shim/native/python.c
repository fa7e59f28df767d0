/* SPDX-License-Identifier: MIT */
/* A domain whose methods are Python's.
 *
 * A callback made by ctypes returns 0, which means success, when an exception strikes before the
 * first line of the method: Ctrl-C may. So these callbacks call Python through the interpreter's
 * own interface, which says without fail whether there was an exception. It is kept until the
 * agent's call has ended, and raised then. The functions are of Python's stable ABI. */
#include "shim.h"

static struct {
    int (*ensure)(void);
    void (*release)(int state);
    void *(*call)(void *callable, const char *format, ...);
    long long (*number)(void *object);
    void (*fetch)(void **type, void **value, void **traceback);
    void (*restore)(void *type, void *value, void *traceback);
    void (*drop)(void *object);
} python;

void rlvc_shim_python_init(int (*ensure)(void), void (*release)(int),
                           void *(*call)(void *, const char *, ...), long long (*number)(void *),
                           void (*fetch)(void **, void **, void **),
                           void (*restore)(void *, void *, void *), void (*drop)(void *)) {
    python.ensure = ensure;
    python.release = release;
    python.call = call;
    python.number = number;
    python.fetch = fetch;
    python.restore = restore;
    python.drop = drop;
}

void rlvc_shim_python_forget(rlvc_shim_python *methods) {
    python.drop(methods->type);
    python.drop(methods->value);
    python.drop(methods->traceback);
    methods->type = methods->value = methods->traceback = NULL;
}

rlvc_status rlvc_shim_python_raise(rlvc_shim_python *methods) {
    if (methods->type)
        python.restore(methods->type, methods->value, methods->traceback);
    methods->type = methods->value = methods->traceback = NULL;
    return RLVC_E_CALLBACK;
}

/* ------------------------------------------------------------------ calling a method */

static int enter(rlvc_shim_python *methods) {
    methods->depth++;
    return python.ensure();
}

/* Takes what a method returned, a number from 0 on, or null after an exception.
 * @return 0; 1 after an exception, which is kept. */
static int leave(rlvc_shim_python *methods, int state, void *result, uint32_t *number) {
    long long value = result ? python.number(result) : -1;
    python.drop(result);
    if (value < 0) {
        rlvc_shim_python_forget(methods);
        python.fetch(&methods->type, &methods->value, &methods->traceback);
    }
    methods->depth--;
    python.release(state);
    *number = value < 0 ? 0 : (uint32_t)value;
    return value < 0;
}

/* As the format K takes it. */
static unsigned long long address(const void *pointer) {
    return (unsigned long long)(uintptr_t)pointer;
}

static int exhibits(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    rlvc_shim_python *methods = (rlvc_shim_python *)ctx;
    int state = enter(methods);
    void *result = python.call(methods->exhibits, "KK", address(percept), address(feature));
    uint32_t number;
    int failed = leave(methods, state, result, &number);
    *present = number == 1u;
    return failed;
}

static int candidates(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written) {
    rlvc_shim_python *methods = (rlvc_shim_python *)ctx;
    int state = enter(methods);
    void *result =
        python.call(methods->candidates, "KIIK", address(samples), first, room, address(features));
    return leave(methods, state, result, written);
}

static int detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns) {
    rlvc_shim_python *methods = (rlvc_shim_python *)ctx;
    int state = enter(methods);
    void *result = python.call(methods->detect, "KIIKIK", address(samples), first, n,
                               address(features), m, address(columns));
    uint32_t ignored;
    return leave(methods, state, result, &ignored);
}

static int oracle(void *ctx, const rlvc_samples *samples, uint32_t below, void *feature,
                  uint32_t *considered) {
    rlvc_shim_python *methods = (rlvc_shim_python *)ctx;
    int state = enter(methods);
    void *result = python.call(methods->oracle, "KIK", address(samples), below, address(feature));
    return leave(methods, state, result, considered);
}

static int name(void *ctx, const void *feature, char *text, uint32_t room) {
    rlvc_shim_python *methods = (rlvc_shim_python *)ctx;
    int state = enter(methods);
    void *result = python.call(methods->name, "KKI", address(feature), address(text), room);
    uint32_t ignored;
    return leave(methods, state, result, &ignored);
}

/* Refuses the record also after an exception. */
static int check(rlvc_shim_python *methods, void *method, const void *record) {
    int state = enter(methods);
    void *result = python.call(method, "(K)", address(record));
    uint32_t sound;
    return leave(methods, state, result, &sound) || !sound;
}

static int check_percept(void *ctx, const void *percept) {
    rlvc_shim_python *methods = (rlvc_shim_python *)ctx;
    return check(methods, methods->check_percept, percept);
}

static int check_feature(void *ctx, const void *feature) {
    rlvc_shim_python *methods = (rlvc_shim_python *)ctx;
    return check(methods, methods->check_feature, feature);
}

void rlvc_shim_python_domain(rlvc_shim_python *methods, rlvc_domain *domain) {
    domain->ctx = methods;
    domain->exhibits = exhibits;
    domain->method = &rlvc_method_classes;
    domain->candidates = candidates;
    domain->detect = methods->detect ? detect : NULL;
    domain->oracle = methods->oracle ? oracle : NULL;
    domain->name = name;
    domain->check_percept = methods->check_percept ? check_percept : NULL;
    domain->check_feature = methods->check_feature ? check_feature : NULL;
}
