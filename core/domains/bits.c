/* SPDX-License-Identifier: MIT */
/* The domain of bits (section 6.1).
 *
 * The batch detector loads, for each of 64 samples, the bits of features within 64 of each other as
 * one word, and so has a matrix of 64 rows (samples) that it wants by columns (features). It
 * transposes in six steps: step j = 32, 16, ..., 1 exchanges, in each square of 2j x 2j bits on the
 * diagonal, the two j x j squares off it. */
#include "rlvc/float_rules.h"

#include "rlvc/bits.h"

#define WORD_BITS 64u

/* Fetches memory that is wanted soon: in the order of their targets, samples lie all over the
 * ring. */
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__aarch64__))
#define FETCH(address) __builtin_prefetch(address)
#else
#define FETCH(address) ((void)(address))
#endif

/* The domain's ctx is their number less 1, which fits into a pointer of 16 bits, too. */
static uint32_t bits_of(const void *ctx) {
    return (uint32_t)(uintptr_t)ctx + 1u;
}

static uint64_t bit_of(const unsigned char *percept, uint32_t bit) {
    return (uint64_t)(percept[bit / 8u] >> (bit % 8u)) & 1u;
}

static int exhibits(void *ctx, const void *percept, const void *feature, uint8_t *present) {
    (void)ctx;
    *present = (uint8_t)bit_of((const unsigned char *)percept, rlvc_bits_feature(feature));
    return 0;
}

/* Every bit, in order. */
static int candidates(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t room,
                      void *features, uint32_t *written) {
    unsigned char *byte = (unsigned char *)features;
    const uint32_t bits = bits_of(ctx);
    uint32_t n = 0;
    (void)samples;
    for (; n < room && first + n < bits; n++) {
        byte[2u * n] = (unsigned char)((first + n) % 256u);
        byte[2u * n + 1u] = (unsigned char)((first + n) / 256u);
    }
    *written = n;
    return 0;
}

/* Bytes as a number, low byte first: written out, so that compilers make one load of them. */
static inline uint32_t load_4(const unsigned char *byte) {
    return (uint32_t)byte[0] | (uint32_t)byte[1] << 8 | (uint32_t)byte[2] << 16 |
           (uint32_t)byte[3] << 24;
}

static inline uint64_t load_8(const unsigned char *byte) {
    return (uint64_t)load_4(byte + 4) << 32 | load_4(byte);
}

/* Bits [first, first + 64) of a percept; what lies beyond its `bytes` bytes reads as 0. */
static inline uint64_t load_window(const unsigned char *percept, uint32_t bytes, uint32_t first) {
    const unsigned char *byte = percept + first / 8u;
    const uint32_t room = bytes - first / 8u;
    const uint32_t shift = first % 8u;
    if (room >= 8u) {
        uint64_t ninth = shift > 0 && room > 8u ? byte[8] : 0u;
        return load_8(byte) >> shift | ninth << 8 << (56u - shift);
    }
    uint64_t window = room >= 4u ? load_4(byte) : 0u;
    for (uint32_t i = room & 4u; i < room; i++)
        window |= (uint64_t)byte[i] << (8u * i);
    return window >> shift;
}

/* One step: `low` has the lower j of every 2j bits. Only squares above row `wanted` are done. */
static inline void exchange(uint64_t *row, uint32_t j, uint64_t low, uint32_t wanted) {
    for (uint32_t square = 0; square < wanted; square += 2u * j) {
        for (uint32_t i = square; i < square + j; i++) {
            uint64_t upper = row[i];
            uint64_t lower = row[i + j];
            row[i] = (upper & low) | (lower & low) << j;
            row[i + j] = (upper >> j & low) | (lower & ~low);
        }
    }
}

/* Bit i of row[j] and bit j of row[i] change places. Only rows [0, wanted) come out right. */
static void transpose(uint64_t row[WORD_BITS], uint32_t wanted) {
    exchange(row, 32, 0x00000000ffffffffu, wanted);
    exchange(row, 16, 0x0000ffff0000ffffu, wanted);
    exchange(row, 8, 0x00ff00ff00ff00ffu, wanted);
    exchange(row, 4, 0x0f0f0f0f0f0f0f0fu, wanted);
    exchange(row, 2, 0x3333333333333333u, wanted);
    exchange(row, 1, 0x5555555555555555u, wanted);
}

/* The features' lowest bit, and in *span the bits from it to the highest. */
static uint32_t lowest_of(const unsigned char *feature, uint32_t m, uint32_t *span) {
    uint32_t lowest = rlvc_bits_feature(feature), highest = lowest;
    for (uint32_t j = 1; j < m; j++) {
        const uint32_t bit = rlvc_bits_feature(feature + (size_t)j * RLVC_BITS_FEATURE_BYTES);
        lowest = bit < lowest ? bit : lowest;
        highest = bit > highest ? bit : highest;
    }
    *span = highest - lowest + 1u;
    return lowest;
}

static int detect(void *ctx, const rlvc_samples *samples, uint32_t first, uint32_t n,
                  const void *features, uint32_t m, uint64_t *columns) {
    const unsigned char *feature = (const unsigned char *)features;
    uint64_t row[WORD_BITS] = {0};
    uint32_t span;
    const uint32_t begin = lowest_of(feature, m, &span);
    const int near = span <= WORD_BITS;
    (void)ctx;
    for (uint32_t i = 0; i < n; i++) {
        const void *percept = rlvc_samples_percept(samples, first + i);
        const uint32_t later = first + i + RLVC_DETECT_SAMPLES;
        if (later < samples->count)
            FETCH((const unsigned char *)rlvc_samples_percept(samples, later) + begin / 8u);
        if (near)
            row[i] = load_window((const unsigned char *)percept, samples->percept_bytes, begin);
        for (uint32_t j = 0; !near && j < m; j++) {
            const unsigned char *wanted = feature + (size_t)j * RLVC_BITS_FEATURE_BYTES;
            row[j] |= bit_of((const unsigned char *)percept, rlvc_bits_feature(wanted)) << i;
        }
    }
    if (near)
        transpose(row, span);
    for (uint32_t j = 0; j < m; j++)
        columns[j] =
            row[near ? rlvc_bits_feature(feature + (size_t)j * RLVC_BITS_FEATURE_BYTES) - begin
                     : j];
    return 0;
}

static int name(void *ctx, const void *feature, char *text, uint32_t room) {
    const char *word = "bit ";
    uint32_t bit = rlvc_bits_feature(feature);
    uint32_t power = 1;
    uint32_t n = 0;
    (void)ctx;
    while (bit / power >= 10u)
        power *= 10u;
    for (; *word != '\0' && n + 1u < room; n++)
        text[n] = *word++;
    for (; power > 0 && n + 1u < room; n++) {
        text[n] = (char)('0' + bit / power % 10u);
        power /= 10u;
    }
    text[n] = '\0';
    return 0;
}

/* Of a percept any bits will do. */
static int check_feature(void *ctx, const void *feature) {
    return rlvc_bits_feature(feature) >= bits_of(ctx);
}

rlvc_status rlvc_bits_domain(uint32_t bits, rlvc_domain *domain) {
    if (domain == NULL)
        return RLVC_E_NULL;
    if (bits == 0 || bits > RLVC_BITS_MAX)
        return RLVC_E_RANGE;
    const rlvc_domain made = {
        .ctx = (void *)(uintptr_t)(bits - 1u),
        .percept_bytes = RLVC_BITS_PERCEPT_BYTES(bits),
        .feature_bytes = RLVC_BITS_FEATURE_BYTES,
        .features_max = bits,
        .kind = RLVC_DOMAIN_BITS,
        .exhibits = exhibits,
        .candidates = candidates,
        .detect = detect,
        .name = name,
        .check_feature = check_feature,
        .method = &rlvc_method_classes,
    };
    *domain = made;
    return RLVC_OK;
}
