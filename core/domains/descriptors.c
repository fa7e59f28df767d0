/* SPDX-License-Identifier: MIT */
/* The domain of local descriptors (sections 3 and 6.2).
 *
 * Distances stay squared. That of two float vectors is summed in eight lanes, number i in lane i
 * mod 8, which compilers make vector code of without leave to reorder; lane by lane it only grows,
 * and so does the rounded sum of the lanes. Hence a sum that is above the limit after a part of the
 * numbers is above it after all of them, and to stop there changes no answer. Int8 vectors have
 * distances of at most 256 * 255^2 < 2^24, which a float holds exactly.
 *
 * The margin rule. A feature is worth most if its radius passes between percepts, not through a
 * crowd of them: the same thing seen from elsewhere, or in other light, is a little nearer or
 * farther. So the distances of the class's percepts that lie within [tau / m, m tau] are counted in
 * BINS equal intervals, and the radius is put into the longest row of empty ones which has a
 * percept on both sides. It is put near the far end: what was never seen of the thing itself tends
 * to be farther off than what was. */
#include "rlvc/float_rules.h"

#include "rlvc/descriptors.h"

#include <string.h>

#define LANES 8u
#define CHUNK 32u /* numbers between two looks at the limit */
#define BINS 64u
#define GAP_MIN 7u    /* bins; narrower gaps are refused */
#define GAP_BEYOND 5u /* the radius leaves 1 / GAP_BEYOND of the gap beyond it */
#define MEASURED 512u /* percepts */
#define STRIDE 1733u  /* between them: a prime, so that the first come from many targets */
#define INT8_FARTHEST 16777216.0f
#define NUMBER_MAX 1e15f
#define MARGIN_MAX 16.0f
#define REFUSED (-1.0f)

/* ------------------------------------------------------------------ records */

static uint32_t vector_bytes(const rlvc_descriptors *d) {
    return RLVC_DESCRIPTORS_VECTOR_BYTES(d->dimensions, d->form);
}

static uint32_t feature_bytes(const rlvc_descriptors *d) {
    return RLVC_DESCRIPTORS_FEATURE_BYTES(d->dimensions, d->form);
}

static uint32_t count_of(const void *percept) {
    uint32_t count;
    memcpy(&count, percept, sizeof count);
    return count;
}

/* Vector i of a percept; with i = 0 also the vector of a feature. */
static const void *vector_at(const rlvc_descriptors *d, const void *record, uint32_t i) {
    return (const unsigned char *)record + 4u + (size_t)i * vector_bytes(d);
}

float rlvc_descriptors_radius(const void *feature) {
    float radius;
    memcpy(&radius, feature, sizeof radius);
    return radius;
}

/* ------------------------------------------------------------------ distances */

static inline float sum_of(const float lane[LANES]) {
    return ((lane[0] + lane[4]) + (lane[2] + lane[6])) +
           ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

/* The squared distance; if it is above the limit, any number above the limit. */
static float between_floats(const float *a, const float *b, uint32_t n, float limit) {
    float lane[LANES] = {0.0f};
    uint32_t i = 0;
    for (; n - i >= CHUNK; i += CHUNK) {
        for (uint32_t k = 0; k < CHUNK; k++) {
            const float difference = a[i + k] - b[i + k];
            lane[k % LANES] += difference * difference;
        }
        if (sum_of(lane) > limit)
            return sum_of(lane);
    }
    for (; n - i >= LANES; i += LANES)
        for (uint32_t k = 0; k < LANES; k++) {
            const float difference = a[i + k] - b[i + k];
            lane[k] += difference * difference;
        }
    for (uint32_t k = 0; k < n - i; k++) {
        const float difference = a[i + k] - b[i + k];
        lane[k] += difference * difference;
    }
    return sum_of(lane);
}

/* Likewise. Chunks are of a length that is not known beforehand, but is a multiple of 16: of that
 * compilers make vector code, while a loop of 16 would be unrolled. */
static inline int32_t between_bytes(const int8_t *a, const int16_t *b, uint32_t n, int32_t limit) {
    const uint32_t even = n & ~15u;
    int32_t sum = 0;
    uint32_t i = 0;
    while (i < even && sum <= limit) {
        const uint32_t to = even - i < CHUNK ? even : i + CHUNK;
        for (; i < to; i++) {
            const int16_t difference = (int16_t)(a[i] - b[i]);
            sum += (int32_t)difference * difference;
        }
    }
    for (; i < n; i++) {
        const int16_t difference = (int16_t)(a[i] - b[i]);
        sum += (int32_t)difference * difference;
    }
    return sum;
}

/* The vector of a feature in the form that distances are taken in. */
typedef struct probe {
    const float *number;
    int16_t wide[RLVC_DESCRIPTORS_DIMENSIONS_MAX]; /* of int8 vectors: distances take less work */
} probe;

static void open_probe(const rlvc_descriptors *d, const void *feature, probe *made) {
    const void *vector = vector_at(d, feature, 0);
    made->number = (const float *)vector;
    for (uint32_t k = 0; k < d->dimensions && d->form == RLVC_DESCRIPTORS_INT8; k++)
        made->wide[k] = ((const int8_t *)vector)[k];
}

/* The number that follows a finite one that is not negative. */
static float after(float number) {
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    bits++;
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* The least whole number that is not below a squared distance; none of int8 vectors reaches the
 * highest. */
static int32_t whole_of(float squared) {
    if (!(squared < INT8_FARTHEST))
        return (int32_t)INT8_FARTHEST;
    const int32_t below = (int32_t)squared;
    return below + ((float)below < squared);
}

/* The least squared distance that is below the limit, else the limit. The first that is below
 * `enough` will do. *point, where it is. */
static int32_t nearest_bytes(const int8_t *vector, uint32_t count, uint32_t n,
                             const int16_t *wanted, int32_t enough, int32_t limit,
                             uint32_t *point) {
    int32_t least = limit;
    for (uint32_t i = 0; i < count && least >= enough; i++, vector += n) {
        const int32_t squared = between_bytes(vector, wanted, n, least);
        if (squared < least) {
            least = squared;
            *point = i;
        }
    }
    return least;
}

static float nearest_floats(const float *vector, uint32_t count, uint32_t n, const float *wanted,
                            float enough, float limit, uint32_t *point) {
    float least = limit;
    for (uint32_t i = 0; i < count && least >= enough; i++, vector += n) {
        const float squared = between_floats(vector, wanted, n, least);
        if (squared < least) {
            least = squared;
            *point = i;
        }
    }
    return least;
}

static float nearest(const rlvc_descriptors *d, const void *percept, const probe *wanted,
                     float enough, float limit, uint32_t *point) {
    const void *vectors = vector_at(d, percept, 0);
    const uint32_t count = count_of(percept);
    if (d->form != RLVC_DESCRIPTORS_INT8)
        return nearest_floats((const float *)vectors, count, d->dimensions, wanted->number, enough,
                              limit, point);
    const int32_t beyond = whole_of(limit);
    const int32_t least = nearest_bytes((const int8_t *)vectors, count, d->dimensions, wanted->wide,
                                        whole_of(enough), beyond, point);
    return least < beyond ? (float)least : limit;
}

static uint8_t within(const rlvc_descriptors *d, const void *percept, const void *feature) {
    const float radius = rlvc_descriptors_radius(feature);
    if (radius < 0.0f)
        return 0;
    const float beyond = after(radius * radius);
    uint32_t point = 0;
    probe wanted;
    open_probe(d, feature, &wanted);
    return nearest(d, percept, &wanted, beyond, beyond, &point) < beyond;
}

static int exhibits(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    const rlvc_descriptors *d = (const rlvc_descriptors *)ctx;
    if (count_of(percept) > d->points)
        return -1;
    *present = within(d, percept, feature);
    return 0;
}

/* A percept at a time, while it is in the cache, against the whole block of features. */
static int detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns) {
    const rlvc_descriptors *d = (const rlvc_descriptors *)ctx;
    uint64_t column[RLVC_DETECT_FEATURES] = {0};
    for (uint32_t i = 0; i < n; i++) {
        const void *percept = rlvc_samples_percept(samples, first + i);
        const unsigned char *feature = (const unsigned char *)features;
        if (count_of(percept) > d->points)
            return -1;
        for (uint32_t j = 0; j < m; j++, feature += feature_bytes(d))
            column[j] |= (uint64_t)within(d, percept, feature) << i;
    }
    memcpy(columns, column, m * sizeof *columns);
    return 0;
}

/* ------------------------------------------------------------------ the margin rule */

/* How the class's percepts lie about a vector, as far as they have been looked at. A row of empty
 * bins can only shrink. So bins count only from the first to the last row that is still longer than
 * what is asked for: of percepts beyond, it need not be known how far they are. */
typedef struct crowd {
    float edge[BINS + 1u]; /* squared distances between which the bins lie */
    uint8_t taken[BINS];   /* is there a percept in the bin? */
    uint32_t from, to;     /* the bins that count; none if equal */
    uint8_t nearer;        /* is there a percept before them, */
    uint8_t farther;       /* or behind? */
} crowd;

/* What a vector's distances leave empty. */
typedef struct gap {
    uint32_t width; /* bins; 0: there is none */
    float radius;   /* in it */
} gap;

static float low_of(const rlvc_descriptors *d) {
    return d->radius / d->margin;
}

static float step_of(const rlvc_descriptors *d) {
    return (d->radius * d->margin - low_of(d)) / (float)BINS;
}

static void open_crowd(const rlvc_descriptors *d, crowd *made) {
    memset(made, 0, sizeof *made);
    for (uint32_t b = 0; b <= BINS; b++) {
        const float edge = low_of(d) + step_of(d) * (float)b;
        made->edge[b] = edge * edge;
    }
    made->to = BINS;
}

/* Leaves out the bins before and behind all rows longer than `width`. */
static void narrow(crowd *all, uint32_t width) {
    uint32_t row = 0, from = all->to, to = all->from;
    for (uint32_t b = all->from; b < all->to; b++) {
        row = all->taken[b] ? 0 : row + 1u;
        if (row > width) {
            from = from < b + 1u - row ? from : b + 1u - row;
            to = b + 1u;
        }
    }
    for (uint32_t b = all->from; b < all->to; b++) {
        all->nearer |= (uint8_t)(all->taken[b] && b < from);
        all->farther |= (uint8_t)(all->taken[b] && b >= to);
    }
    all->from = from < to ? from : to;
    all->to = to;
}

/* Puts a percept to the others, by its squared distance. */
static void join(crowd *all, float squared, uint32_t width) {
    uint32_t low = all->from, high = all->to;
    if (squared < all->edge[low]) {
        all->nearer = 1;
        return;
    }
    if (squared >= all->edge[high]) {
        all->farther = 1;
        return;
    }
    while (high - low > 1u) {
        const uint32_t middle = (low + high) / 2u;
        if (squared < all->edge[middle])
            high = middle;
        else
            low = middle;
    }
    if (!all->taken[low]) {
        all->taken[low] = 1;
        narrow(all, width);
    }
}

/* The longest row of empty bins with a percept on both sides, of equals the nearest. */
static gap widest(const rlvc_descriptors *d, const crowd *all) {
    gap best = {0, REFUSED};
    uint32_t row = 0, last = all->farther ? all->to : all->from;
    uint8_t nearer = all->nearer;
    for (uint32_t b = all->from; b < all->to; b++)
        last = all->taken[b] && last < b ? b : last;
    for (uint32_t b = all->from; b < last; b++) {
        row = all->taken[b] ? 0 : row + 1u;
        nearer |= all->taken[b];
        if (row > best.width && nearer) {
            best.width = row;
            best.radius =
                low_of(d) + step_of(d) * ((float)(b + 1u) - (float)row / (float)GAP_BEYOND);
        }
    }
    return best;
}

/* Measures a feature's vector against the class: finds its gap, if that is wider than *found. */
static int measure(const rlvc_descriptors *d, const rlvc_samples *samples, const void *feature,
                   gap *found) {
    const uint32_t measured = samples->count < MEASURED ? samples->count : MEASURED;
    uint32_t at = 0, point = 0;
    crowd all;
    probe wanted;
    open_crowd(d, &all);
    open_probe(d, feature, &wanted);
    for (uint32_t i = 0; i < measured && all.from < all.to; i++) {
        const void *percept =
            rlvc_samples_percept(samples, (uint32_t)((uint64_t)at * samples->count / measured));
        if (count_of(percept) > d->points)
            return -1;
        join(&all, nearest(d, percept, &wanted, all.edge[all.from], all.edge[all.to], &point),
             found->width);
        at = (at + STRIDE) % measured;
    }
    const gap made = widest(d, &all);
    if (made.width > found->width)
        *found = made;
    return 0;
}

/* ------------------------------------------------------------------ candidates */

/* A number that looks random (an integer hash by multiplication). */
static uint32_t scatter(uint32_t x) {
    x = (x ^ x >> 16) * 0x45d9f3bu;
    x = (x ^ x >> 16) * 0x45d9f3bu;
    return x ^ x >> 16;
}

static int begins_run(const rlvc_samples *samples, uint32_t i) {
    return i == 0 || samples->sample[i].key != samples->sample[i - 1u].key;
}

static uint32_t count_runs(const rlvc_samples *samples) {
    uint32_t runs = 0;
    for (uint32_t i = 0; i < samples->count; i++)
        runs += (uint32_t)begins_run(samples, i);
    return runs;
}

/* Where run number `run` of samples with equal targets begins and ends. */
static void find_run(const rlvc_samples *samples, uint32_t run, uint32_t *begin, uint32_t *end) {
    uint32_t at = 0;
    for (uint32_t left = run + 1u; left > 0; at++)
        left -= (uint32_t)begins_run(samples, at);
    *begin = at - 1u;
    while (at < samples->count && !begins_run(samples, at))
        at++;
    *end = at;
}

static int is_among(const unsigned char *features, uint32_t count, uint32_t bytes,
                    const unsigned char *feature) {
    for (uint32_t j = 0; j < count; j++)
        if (memcmp(features + (size_t)j * bytes + 4u, feature + 4u, bytes - 4u) == 0)
            return 1;
    return 0;
}

/* Puts vector `pick` of a percept, counted round, into the record behind the block's `written`
 * features. 0: it was not to be had, or is among them. */
static int put(const rlvc_descriptors *d, const void *percept, uint32_t pick,
               unsigned char *features, uint32_t written, unsigned char *record) {
    const uint32_t count = count_of(percept);
    if (count == 0)
        return 0;
    memcpy(record + 4u, vector_at(d, percept, pick % count), vector_bytes(d));
    return !is_among(features, written, feature_bytes(d), record);
}

/* Draws the vectors of candidate number `number` from samples [begin, end), and keeps the best. */
static int draw(const rlvc_descriptors *d, const rlvc_samples *samples, uint32_t number,
                const uint32_t run[2], unsigned char *features, uint32_t written) {
    float aligned[1u + RLVC_DESCRIPTORS_DIMENSIONS_MAX] = {0.0f};
    unsigned char *record = (unsigned char *)aligned;
    unsigned char *out = features + (size_t)written * feature_bytes(d);
    const uint32_t draws = d->margin > 1.0f ? d->draws : 1u;
    const gap fixed = {BINS, d->radius};
    gap best = {GAP_MIN - 1u, REFUSED};
    memset(out, 0, feature_bytes(d));
    memcpy(out, &best.radius, sizeof best.radius);
    for (uint32_t t = 0; t < draws; t++) {
        const uint32_t chance = scatter(number * RLVC_DESCRIPTORS_DRAWS_MAX + t + 1u);
        const void *percept = rlvc_samples_percept(samples, run[0] + chance % (run[1] - run[0]));
        gap found = best;
        if (count_of(percept) > d->points)
            return -1;
        if (!put(d, percept, scatter(chance), features, written, record))
            continue;
        if (!(d->margin > 1.0f))
            found = fixed;
        else if (measure(d, samples, record, &found) != 0)
            return -1;
        if (found.width > best.width) {
            best = found;
            memcpy(out, record, feature_bytes(d));
            memcpy(out, &best.radius, sizeof best.radius);
        }
    }
    return 0;
}

/* Candidate i comes from the samples of one target: of the i-th of them round and round, or of
 * every so manieth if there are more targets than candidates. */
static int candidates(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written) {
    const rlvc_descriptors *d = (const rlvc_descriptors *)ctx;
    const uint32_t runs = count_runs(samples);
    uint32_t n = 0;
    for (; n < room && first + n < d->candidates; n++) {
        const uint32_t i = first + n;
        uint32_t run[2];
        find_run(samples,
                 runs < d->candidates ? i % runs : (uint32_t)((uint64_t)i * runs / d->candidates),
                 &run[0], &run[1]);
        if (draw(d, samples, i, run, (unsigned char *)features, n) != 0)
            return -1;
    }
    *written = n;
    return 0;
}

/* Byte i of a feature's record as it is stored: of numbers the lowest first. */
static uint32_t stored_byte(const rlvc_descriptors *d, const void *feature, uint32_t i) {
    const unsigned char *byte = (const unsigned char *)feature;
    uint32_t number;
    if (i >= 4u && d->form == RLVC_DESCRIPTORS_INT8)
        return byte[i];
    memcpy(&number, byte + i / 4u * 4u, sizeof number);
    return number >> 8u * (i % 4u) & 255u;
}

/* "vector " and eight hexadecimal digits, a hash (FNV-1a) of the record. */
static int name(void *ctx, const void *feature, char *text, uint32_t room) {
    const rlvc_descriptors *d = (const rlvc_descriptors *)ctx;
    const char *word = "vector ";
    uint32_t sum = 2166136261u, n = 0;
    for (uint32_t i = 0; i < feature_bytes(d); i++)
        sum = (sum ^ stored_byte(d, feature, i)) * 16777619u;
    for (; *word != '\0' && n + 1u < room; n++)
        text[n] = *word++;
    for (uint32_t digit = 0; digit < 8u && n + 1u < room; digit++, n++)
        text[n] = "0123456789abcdef"[sum >> (28u - 4u * digit) & 15u];
    text[n] = '\0';
    return 0;
}

/* ------------------------------------------------------------------ the interface */

rlvc_status rlvc_descriptors_default(rlvc_descriptors *descriptors, uint32_t points,
                                     uint32_t dimensions, uint32_t form, float radius) {
    if (descriptors == NULL)
        return RLVC_E_NULL;
    const rlvc_descriptors made = {
        .points = points,
        .dimensions = dimensions,
        .candidates = 64u,
        .draws = 8u,
        .radius = radius,
        .margin = 1.8f,
        .form = (uint8_t)form,
    };
    *descriptors = made;
    return RLVC_OK;
}

static int in(uint32_t value, uint32_t low, uint32_t high) {
    return value >= low && value <= high;
}

/* A percept of the most points and dimensions is below the 2^20 bytes that a domain may have. */
static int is_valid(const rlvc_descriptors *d) {
    return in(d->points, 1, RLVC_DESCRIPTORS_POINTS_MAX) &&
           in(d->dimensions, 1, RLVC_DESCRIPTORS_DIMENSIONS_MAX) &&
           in(d->candidates, 1, RLVC_DESCRIPTORS_CANDIDATES_MAX) &&
           in(d->draws, 1, RLVC_DESCRIPTORS_DRAWS_MAX) && d->form <= RLVC_DESCRIPTORS_INT8 &&
           d->radius > 0.0f && d->radius <= NUMBER_MAX && d->margin >= 1.0f &&
           d->margin <= MARGIN_MAX;
}

/* Are the first numbers at a place finite and in range? */
static int are_numbers(const float *number, uint32_t count) {
    uint32_t i = 0;
    while (i < count && number[i] >= -NUMBER_MAX && number[i] <= NUMBER_MAX)
        i++;
    return i == count;
}

static int check_percept(void *ctx, const void *percept) {
    const rlvc_descriptors *d = (const rlvc_descriptors *)ctx;
    const uint32_t count = count_of(percept);
    if (count > d->points)
        return 1;
    return d->form == RLVC_DESCRIPTORS_FLOAT &&
           !are_numbers((const float *)vector_at(d, percept, 0), count * d->dimensions);
}

static int check_feature(void *ctx, const void *feature) {
    const rlvc_descriptors *d = (const rlvc_descriptors *)ctx;
    const float radius = rlvc_descriptors_radius(feature);
    if (!(radius >= REFUSED && radius <= MARGIN_MAX * NUMBER_MAX))
        return 1;
    return d->form == RLVC_DESCRIPTORS_FLOAT &&
           !are_numbers((const float *)vector_at(d, feature, 0), d->dimensions);
}

rlvc_status rlvc_descriptors_domain(rlvc_descriptors *descriptors, rlvc_domain *domain) {
    if (descriptors == NULL || domain == NULL)
        return RLVC_E_NULL;
    if (!is_valid(descriptors))
        return RLVC_E_RANGE;
    const uint32_t numbers = /* of 4 bytes, in a vector */
        descriptors->form == RLVC_DESCRIPTORS_FLOAT ? descriptors->dimensions : 0;
    const rlvc_domain made = {
        .ctx = descriptors,
        .percept_bytes = RLVC_DESCRIPTORS_PERCEPT_BYTES(descriptors->points,
                                                        descriptors->dimensions, descriptors->form),
        .feature_bytes = feature_bytes(descriptors),
        .features_max = descriptors->candidates,
        .kind = RLVC_DOMAIN_DESCRIPTORS,
        .exhibits = exhibits,
        .candidates = candidates,
        .detect = detect,
        .name = name,
        .check_percept = check_percept,
        .check_feature = check_feature,
        .percept_words = 1u + numbers * descriptors->points,
        .feature_words = 1u + numbers,
    };
    *domain = made;
    return RLVC_OK;
}

rlvc_status rlvc_descriptors_nearest(const rlvc_descriptors *descriptors, const void *percept,
                                     const void *feature, uint32_t *point, float *squared) {
    const float unlimited = 3e38f;
    if (descriptors == NULL || percept == NULL || feature == NULL)
        return RLVC_E_NULL;
    const uint32_t count = count_of(percept);
    if (count == 0 || count > descriptors->points)
        return RLVC_E_RANGE;
    uint32_t at = 0;
    probe wanted;
    open_probe(descriptors, feature, &wanted);
    const float least = nearest(descriptors, percept, &wanted, 0.0f, unlimited, &at);
    if (point != NULL)
        *point = at;
    if (squared != NULL)
        *squared = least;
    return RLVC_OK;
}
