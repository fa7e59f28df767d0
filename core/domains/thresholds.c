/* SPDX-License-Identifier: MIT */
/* The domain of thresholds: real numbers as percepts.
 *
 * What is compared with a cutpoint is the value v of a percept along a direction: x[i], or x[i] + w
 * x[j]. Candidates are numbered direction by direction, and within one by rank: of n samples and m
 * candidates, candidate b puts its cutpoint between the value v of rank b n / m (from 0) and the
 * least value above v. It has none if v is that of the candidate before it, or the highest. With m
 * = n these are all midpoints between neighbours, and exact search is nothing else.
 *
 * A value's key is its bits made to order as the value does. The value of a rank is found by its
 * key, a digit of eight bits at a time from the highest: one pass counts the digits of the keys
 * that begin as those found so far, and the next digit is where the sum of the counts passes the
 * rank. So nothing is sorted and no memory needed but the counts. */
#include "rlvc/float_rules.h"

#include "rlvc/thresholds.h"

#include <string.h>

#define DIGIT_BITS 8u
#define DIGITS 256u
#define SLOPES 6u /* of a pair */
#define NAME_DIGITS 9u

typedef struct direction {
    float slope; /* w; 0: along x[i] */
    uint32_t component;
    uint32_t other;
    int usable;
} direction;

/* ------------------------------------------------------------------ values */

static int is_number(float x) {
    return x >= -RLVC_THRESHOLDS_NUMBER_MAX &&
           x <= RLVC_THRESHOLDS_NUMBER_MAX; /* false for a NaN */
}

/* Has a percept a value along the direction? */
static int has_value(const direction *along, const void *percept) {
    const float *x = (const float *)percept;
    return is_number(x[along->component]) && is_number(x[along->other]);
}

/* v of a percept that has one. */
static float value_of(const direction *along, const void *percept) {
    const float *x = (const float *)percept;
    const float first = x[along->component];
    return along->slope != 0.0f ? first + along->slope * x[along->other] : first;
}

static uint32_t key_of(float value) {
    uint32_t bits;
    value += 0.0f; /* -0 and +0 are the same value */
    memcpy(&bits, &value, sizeof bits);
    return bits >> 31 ? ~bits : bits | 0x80000000u;
}

static float value_of_key(uint32_t key) {
    const uint32_t bits = key >> 31 ? key & 0x7fffffffu : ~key;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t key_at(const rlvc_samples *samples, const direction *along, uint32_t i) {
    return key_of(value_of(along, rlvc_samples_percept(samples, i)));
}

/* ------------------------------------------------------------------ ranks */

/* Counts the digits at `shift` of those keys whose higher digits are `found`'s. */
static void count_digits(const rlvc_samples *samples, const direction *along, uint32_t found,
                         uint32_t shift, uint32_t count[DIGITS]) {
    memset(count, 0, DIGITS * sizeof *count);
    for (uint32_t i = 0; i < samples->count; i++) {
        const uint32_t key = key_at(samples, along, i);
        if (((key ^ found) >> shift) < DIGITS)
            count[key >> shift & (DIGITS - 1u)]++;
    }
}

/* The key of the value of a rank, from 0, which must be below the number of samples. */
static uint32_t key_of_rank(const rlvc_samples *samples, const direction *along, uint64_t rank) {
    uint32_t count[DIGITS];
    uint32_t found = 0;
    for (uint32_t shift = 32u; shift > 0;) {
        uint32_t digit = 0;
        shift -= DIGIT_BITS;
        count_digits(samples, along, found, shift, count);
        for (; rank >= count[digit]; digit++)
            rank -= count[digit];
        found |= digit << shift;
    }
    return found;
}

/* The cutpoint just above the value of a key, or none. */
static float cut_above(const rlvc_samples *samples, const direction *along, uint32_t key) {
    uint32_t next = UINT32_MAX;
    for (uint32_t i = 0; i < samples->count; i++) {
        const uint32_t other = key_at(samples, along, i);
        if (other > key && other < next)
            next = other;
    }
    if (next == UINT32_MAX)
        return RLVC_THRESHOLDS_NONE;
    const float low = value_of_key(key), high = value_of_key(next);
    const float middle = low / 2.0f + high / 2.0f;
    return middle < high ? middle : low;
}

/* ------------------------------------------------------------------ candidates */

static uint32_t count_of_directions(const rlvc_thresholds *t) {
    const uint32_t pairs = t->oblique ? t->components * (t->components - 1u) / 2u : 0;
    return t->components + pairs * SLOPES;
}

/* The distance of a component's quartiles. */
static float spread_of(const rlvc_samples *samples, uint32_t component) {
    const direction along = {0.0f, component, component, 1};
    const uint64_t n = samples->count;
    const uint32_t low = key_of_rank(samples, &along, n / 4u);
    const uint32_t high = key_of_rank(samples, &along, n * 3u / 4u);
    return value_of_key(high) - value_of_key(low);
}

/* Makes direction `number`. One whose slope would be no number, since a component hardly varies, is
 * not usable. Fails if a percept has no value along it. */
static int aim(const rlvc_thresholds *t, const rlvc_samples *samples, uint32_t number,
               direction *along) {
    static const float factor[SLOPES] = {1.0f, -1.0f, 2.0f, -2.0f, 0.5f, -0.5f};
    const direction axis = {0.0f, number, number, 1};
    *along = axis;
    if (number >= t->components) {
        uint32_t i = 0, pair = (number - t->components) / SLOPES;
        for (uint32_t row = t->components - 1u; pair >= row; row--, i++)
            pair -= row;
        along->component = i;
        along->other = i + 1u + pair;
    }
    for (uint32_t i = 0; i < samples->count; i++)
        if (!has_value(along, rlvc_samples_percept(samples, i)))
            return -1;
    if (number < t->components)
        return 0;
    const float wide = spread_of(samples, along->component);
    const float narrow = spread_of(samples, along->other);
    const float slope = narrow > 0.0f ? wide / narrow : 0.0f;
    along->usable = slope > 1.0f / RLVC_THRESHOLDS_NUMBER_MAX && slope < RLVC_THRESHOLDS_NUMBER_MAX;
    along->slope = along->usable ? factor[(number - t->components) % SLOPES] * slope : 0.0f;
    return 0;
}

/* The cutpoint of candidate b of m along a direction, or none. */
static float cut(const rlvc_samples *samples, const direction *along, uint32_t b, uint32_t m) {
    const uint64_t n = samples->count;
    if (!along->usable)
        return RLVC_THRESHOLDS_NONE;
    const uint32_t key = key_of_rank(samples, along, b * n / m);
    if (b > 0 && key == key_of_rank(samples, along, (b - 1u) * n / m))
        return RLVC_THRESHOLDS_NONE;
    return cut_above(samples, along, key);
}

static int candidates(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written) {
    const rlvc_thresholds *t = (const rlvc_thresholds *)ctx;
    const uint32_t m =
        t->cutpoints > 0 && t->cutpoints < samples->count ? t->cutpoints : samples->count;
    const uint64_t end = (uint64_t)count_of_directions(t) * m;
    unsigned char *record = (unsigned char *)features;
    direction along;
    uint32_t n = 0;
    for (; n < room && (uint64_t)first + n < end; n++, record += RLVC_THRESHOLDS_FEATURE_BYTES) {
        const uint32_t b = (first + n) % m;
        if ((n == 0 || b == 0) && aim(t, samples, (first + n) / m, &along) != 0)
            return -1;
        const rlvc_threshold feature = {cut(samples, &along, b, m), along.slope,
                                        (uint16_t)along.component,
                                        (uint16_t)(along.slope != 0.0f ? along.other : 0)};
        memcpy(record, &feature, sizeof feature);
    }
    *written = n;
    return 0;
}

/* ------------------------------------------------------------------ the detector */

static rlvc_threshold feature_of(const void *record) {
    rlvc_threshold feature;
    memcpy(&feature, record, sizeof feature);
    return feature;
}

rlvc_threshold rlvc_thresholds_feature(const void *record) {
    const rlvc_threshold none = {RLVC_THRESHOLDS_NONE, 0.0f, 0, 0};
    return record != NULL ? feature_of(record) : none;
}

static direction direction_of(const rlvc_threshold *feature) {
    const direction along = {feature->slope, feature->component,
                             feature->slope != 0.0f ? feature->other : feature->component, 1};
    return along;
}

static int exhibits(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    const rlvc_threshold wanted = feature_of(feature);
    const direction along = direction_of(&wanted);
    (void)ctx;
    if (!has_value(&along, percept))
        return -1;
    *present = value_of(&along, percept) > wanted.cutpoint;
    return 0;
}

static int detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns) {
    const unsigned char *record = (const unsigned char *)features;
    (void)ctx;
    for (uint32_t j = 0; j < m; j++, record += RLVC_THRESHOLDS_FEATURE_BYTES) {
        const rlvc_threshold wanted = feature_of(record);
        const direction along = direction_of(&wanted);
        uint64_t column = 0;
        for (uint32_t i = 0; i < n; i++) {
            const void *percept = rlvc_samples_percept(samples, first + i);
            if (!has_value(&along, percept))
                return -1;
            column |= (uint64_t)(value_of(&along, percept) > wanted.cutpoint) << i;
        }
        columns[j] = column;
    }
    return 0;
}

/* ------------------------------------------------------------------ names */

/* Strings and numbers, one after another, as far as there is room. */
typedef struct line {
    char *text;
    uint32_t room;
} line;

static void put(line *to, const char *string) {
    for (; *string != '\0' && to->room > 1u; to->room--)
        *to->text++ = *string++;
    *to->text = '\0';
}

static void put_number(line *to, float number) {
    const uint32_t spelt = rlvc_spell(number, NAME_DIGITS, to->text, to->room);
    to->text += spelt;
    to->room -= spelt;
}

static int name(void *ctx, const void *feature, char *text, uint32_t room) {
    const rlvc_threshold named = feature_of(feature);
    line to = {text, room};
    (void)ctx;
    put(&to, "x[");
    put_number(&to, (float)named.component);
    put(&to, "]");
    if (named.slope != 0.0f) {
        put(&to, named.slope < 0.0f ? " - " : " + ");
        put_number(&to, named.slope < 0.0f ? -named.slope : named.slope);
        put(&to, " x[");
        put_number(&to, (float)named.other);
        put(&to, "]");
    }
    put(&to, " > ");
    put_number(&to, named.cutpoint);
    return 0;
}

/* ------------------------------------------------------------------ checks */

static int check_percept(void *ctx, const void *percept) {
    return rlvc_thresholds_check((const rlvc_thresholds *)ctx, percept) != RLVC_OK;
}

static int check_feature(void *ctx, const void *feature) {
    const rlvc_thresholds *t = (const rlvc_thresholds *)ctx;
    const rlvc_threshold checked = feature_of(feature);
    const float cutpoint = checked.cutpoint, slope = checked.slope;
    const int oblique = slope != 0.0f; /* of a NaN, too */
    return !(checked.component < t->components && cutpoint - cutpoint == 0.0f &&
             slope - slope == 0.0f && oblique <= t->oblique &&
             checked.other < (oblique ? t->components : 1u));
}

/* ------------------------------------------------------------------ the interface */

rlvc_status rlvc_thresholds_default(rlvc_thresholds *thresholds, uint32_t components) {
    if (thresholds == NULL)
        return RLVC_E_NULL;
    const rlvc_thresholds made = {.components = components, .cutpoints = 15u};
    *thresholds = made;
    return RLVC_OK;
}

static int is_valid(const rlvc_thresholds *t) {
    const uint32_t most = t->oblique ? RLVC_THRESHOLDS_OBLIQUE_MAX : RLVC_THRESHOLDS_COMPONENTS_MAX;
    return t->components >= 1u && t->components <= most &&
           t->cutpoints <= RLVC_THRESHOLDS_CUTPOINTS_MAX && t->oblique <= 1u;
}

rlvc_status rlvc_thresholds_policy_domain(rlvc_thresholds *thresholds, rlvc_domain *domain) {
    if (thresholds == NULL || domain == NULL)
        return RLVC_E_NULL;
    if (!is_valid(thresholds))
        return RLVC_E_RANGE;
    const rlvc_domain made = {
        .ctx = thresholds,
        .percept_bytes = RLVC_THRESHOLDS_PERCEPT_BYTES(thresholds->components),
        .feature_bytes = RLVC_THRESHOLDS_FEATURE_BYTES,
        .features_max = count_of_directions(thresholds) * thresholds->cutpoints,
        .kind = RLVC_DOMAIN_THRESHOLDS,
        .exhibits = exhibits,
        .candidates = candidates,
        .detect = detect,
        .name = name,
        .check_percept = check_percept,
        .check_feature = check_feature,
        .percept_words = thresholds->components,
        .feature_words = 2u,  /* cutpoint, slope */
        .feature_halves = 2u, /* component, other */
    };
    *domain = made;
    return RLVC_OK;
}

rlvc_status rlvc_thresholds_domain(rlvc_thresholds *thresholds, rlvc_domain *domain) {
    const rlvc_status status = rlvc_thresholds_policy_domain(thresholds, domain);
    if (status == RLVC_OK)
        domain->method = &rlvc_method_planner;
    return status;
}

rlvc_status rlvc_thresholds_check(const rlvc_thresholds *thresholds, const void *percept) {
    if (thresholds == NULL || percept == NULL)
        return RLVC_E_NULL;
    const float *x = (const float *)percept;
    for (uint32_t i = 0; i < thresholds->components; i++)
        if (!is_number(x[i]))
            return RLVC_E_RANGE;
    return RLVC_OK;
}
