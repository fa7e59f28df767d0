/* SPDX-License-Identifier: MIT */
/* The terms of the linear models of the dynamics:
 *
 *     x = [1, z_1 .. z_D, (a == 1) .. (a == A - 1), z_1 z_1, z_2 z_1, z_2 z_2, .. z_D z_D]
 *
 * where z is the percept less its mean, divided by its standard deviation. The short basis leaves
 * out the products. */
#ifndef RLVC_SRC_BASIS_H
#define RLVC_SRC_BASIS_H

#include <stdint.h>

/* The longest basis with products; where it would be longer, there are none. */
#define RLVC_BASIS_PRODUCTS_MAX 64u
#define RLVC_COMPONENTS_MAX 64u

typedef struct rlvc_basis {
    float *mean;  /* [components] */
    float *scale; /* [components] deviation, or 1 where it is 0 */
    uint32_t components;
    uint32_t actions;
} rlvc_basis;

static inline uint32_t rlvc_basis_short(uint32_t components, uint32_t actions) {
    return components + actions;
}

/* The terms of the full basis. */
static inline uint32_t rlvc_basis_full(uint32_t components, uint32_t actions) {
    uint32_t terms = components + actions + components * (components + 1u) / 2u;
    return terms <= RLVC_BASIS_PRODUCTS_MAX ? terms : components + actions;
}

/* x of a percept and an action, `terms` of the short or the full basis. O(terms). */
static inline void rlvc_basis_row(const rlvc_basis *basis, uint32_t terms, const float *percept,
                                  uint32_t action, float *x) {
    uint32_t d = basis->components, at = d + basis->actions;
    x[0] = 1.0f;
    int products = terms > at;
    for (uint32_t i = 1; i <= d; i++) {
        float z = (percept[i - 1u] - basis->mean[i - 1u]) / basis->scale[i - 1u];
        x[i] = z;
        for (uint32_t j = 1; products && j <= i; j++)
            x[at++] = z * x[j];
    }
    for (uint32_t a = 1; a < basis->actions; a++)
        x[d + a] = a == action ? 1.0f : 0.0f;
}

#endif
