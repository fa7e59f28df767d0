/* SPDX-License-Identifier: MIT */
/* Seeing: from a picture to the percept that the core learns from (sections 3 and 6.2).
 *
 *     rlvc_vision_config_default, rlvc_extractor_create          once
 *     rlvc_extractor_extract                                     for each picture
 *     rlvc_fitter_create, _add, _pair, _fit                      once, to fit a metric to a task
 *     rlvc_metric_save, rlvc_metric_load                         beside the learnt policy
 *
 * A picture's interest points are colour Harris points; each is described by a vector of the D
 * numbers of the chosen descriptor. A metric, if there is one, whitens the vectors, so that the
 * distance of two vectors as they stand in a percept is Euclid's, whatever the descriptor.
 *
 * There is no global state. One object is used by one thread at a time; distinct objects are
 * independent, and one metric may be read by many threads. Every function that fails leaves its
 * outputs as they were, and, if the caller passed an rlvc_vision_error, says there in words what
 * was wrong and where. RLVC_VISION_E_NULL (a pointer not marked optional is null),
 * RLVC_VISION_E_MEMORY and RLVC_VISION_E_INTERNAL are not repeated at each function. */
#ifndef RLVC_VISION_H
#define RLVC_VISION_H

#include <stddef.h>
#include <stdint.h>

#include "rlvc/status.h" /* RLVC_API */

#ifdef __cplusplus
extern "C" {
#endif

/* Values are pinned and only ever appended to; none but 0 is also a value of rlvc_status. */
typedef enum rlvc_vision_status {
    RLVC_VISION_OK = 0,
    RLVC_VISION_E_NULL = -101,       /* a pointer that must not be null is null */
    RLVC_VISION_E_CONFIG = -102,     /* a field of the config is out of range */
    RLVC_VISION_E_PICTURE = -103,    /* a field of the picture is out of range */
    RLVC_VISION_E_ROOM = -104,       /* the room given is not the size needed, or too small */
    RLVC_VISION_E_RANGE = -105,      /* another argument is out of range */
    RLVC_VISION_E_FEW = -106,        /* too few pictures, vectors or pairs to fit a metric */
    RLVC_VISION_E_FILE = -107,       /* a file cannot be read or written */
    RLVC_VISION_E_FORMAT = -108,     /* the text is not a metric of a version that is known */
    RLVC_VISION_E_DESCRIPTOR = -109, /* the metric belongs to other vectors */
    RLVC_VISION_E_METRIC = -110,     /* this config needs a metric and there is none */
    RLVC_VISION_E_MEMORY = -111,     /* out of memory */
    RLVC_VISION_E_INTERNAL = -112    /* OpenCV failed where it should not */
} rlvc_vision_status;

/* A constant English sentence for a status; never null, also for a value that is none. O(1). */
RLVC_API const char *rlvc_vision_status_text(rlvc_vision_status status);

/* What was wrong and where, in words: the field, its value and its range; the file and the key. A
 * caller's own, so that it needs no lifetime and works where no object was made. Optional wherever
 * it is a parameter. Ends in 0; longer text is cut. A call that succeeds makes it empty. */
typedef struct rlvc_vision_error {
    char text[256];
} rlvc_vision_error;

/* ------------------------------------------------------------------------------------ config */

/* config.descriptor: what stands in a vector. Values are pinned.
 *
 * - INVARIANTS: the published colour differential invariants of first order, v = (R, |grad R|^2, G,
 *   |grad G|^2, B, |grad B|^2, grad R . grad G, grad R . grad B). A turn leaves them alone.
 * - SQRT_INVARIANTS: the same, with the signed square root of the five terms of second degree,
 *   which makes them nearer to normally distributed.
 * - SIFT_UPRIGHT: SIFT, its window not turned. Length 1.
 * - SIFT: SIFT, turned to the point's own direction. Length 1.
 * - ORB: its 256 bits, turned likewise, as +-1/16. Length 1; the distance is the square root of the
 *   Hamming distance, over 8.
 * - QUARTERS: not of a point but of the whole picture, which has one vector: mean red, green and
 *   blue of its upper left quarter, the upper right, the lower left and the lower right, in grey
 *   levels. It tells places apart that have no corners, as parts of a sky. Its point is the
 *   picture's centre, of response 1, and `normalise` and what concerns points take no notice of it;
 *   its direction is that of the right edge. */
#define RLVC_DESCRIPTOR_INVARIANTS 0u
#define RLVC_DESCRIPTOR_SQRT_INVARIANTS 1u
#define RLVC_DESCRIPTOR_SIFT_UPRIGHT 2u
#define RLVC_DESCRIPTOR_SIFT 3u
#define RLVC_DESCRIPTOR_ORB 4u
#define RLVC_DESCRIPTOR_QUARTERS 5u
#define RLVC_DESCRIPTORS 6u

/* D of each descriptor, and the largest. */
#define RLVC_DIMENSIONS_INVARIANTS 8u
#define RLVC_DIMENSIONS_SIFT 128u
#define RLVC_DIMENSIONS_ORB 256u
#define RLVC_DIMENSIONS_QUARTERS 12u
#define RLVC_DIMENSIONS_MAX 256u

/* config.form: how a number of a vector stands in the percept. Values are pinned. */
#define RLVC_FORM_FLOAT 0u /* binary32 */
#define RLVC_FORM_INT8 1u  /* round(number / rlvc_extractor_step) in [-127, 127], saturating */

/* config.places: what a percept says of where its vectors were found, for features of several
 * points (rlvc/spatial.h). Values are pinned. */
#define RLVC_PLACES_NONE 0u     /* nothing */
#define RLVC_PLACES_POINTS 1u   /* the points */
#define RLVC_PLACES_DIRECTED 2u /* and their directions, those of the smoothed grey gradient */

#define RLVC_POINTS_MAX 1000u

/* Chosen once, copied by whatever takes it. Start from rlvc_vision_config_default. */
typedef struct rlvc_vision_config {
    uint32_t descriptor; /* RLVC_DESCRIPTOR_*. Default: what was asked for */
    uint32_t points;     /* P, the most points of a picture, [1, RLVC_POINTS_MAX]; the strongest are
                            kept. Default 30, QUARTERS 1 */
    uint32_t radius;     /* pixels: a point's response exceeds all others in the square of side
                            2 radius + 1 around it, [1, 31]. Default 3 */
    uint8_t form;        /* RLVC_FORM_*. Default RLVC_FORM_FLOAT */
    uint8_t normalise;   /* 1: each channel of a picture is first brought to mean 128 and standard
                            deviation 64, which removes changes of light of the form a c + b, and
                            absolute colour with them; 0: not. SIFT and ORB take no notice of it but
                            in the choice of points. Default 0 */
    uint8_t axes;    /* numbers of a vector in the percept: the first so many axes of a metric of
                        the kind DISCRIMINANT, [1, D]; 0: all D. Default 0 */
    uint8_t places;  /* RLVC_PLACES_*. Default RLVC_PLACES_NONE */
    float sd;        /* pixels: scale of the derivatives of the Harris response, [0.5, 4].
                           Default 1 */
    float si;        /* pixels: scale over which it integrates, [0.5, 8]. Default 2 */
    float k;         /* H = det M - k (trace M)^2, [0, 0.25). Default 0.04 */
    float threshold; /* a point's response exceeds this share of the picture's largest, [0, 1).
                           Default 0.001 */
    float sigma;     /* pixels: scale of the vectors, [0.5, 8], for SIFT [1, 8]: that of the
                           Gaussian derivatives, or SIFT's own (its window is 12 sigma wide); ORB's
                           window is fixed, and only its direction is taken at this scale. Default
                           2.5, SIFT 6, ORB 5 */
    float noise;     /* grey levels: what noise of this standard deviation makes is no point, so
                           that a plain sky has none, [0, 64]. Default 3 */
} rlvc_vision_config;

/* Fills *config with the defaults for a descriptor. O(1).
 * @return RLVC_VISION_OK; RLVC_VISION_E_RANGE (descriptor), *config unchanged. */
RLVC_API rlvc_vision_status rlvc_vision_config_default(uint32_t descriptor,
                                                       rlvc_vision_config *config);

/* Checks every field. O(1).
 * @return RLVC_VISION_OK; RLVC_VISION_E_CONFIG: *error names the first field out of range. */
RLVC_API rlvc_vision_status rlvc_vision_config_check(const rlvc_vision_config *config,
                                                     rlvc_vision_error *error);

/* Numbers of a vector as it stands in a percept: config.axes, or D if that is 0; 0 if the
 * descriptor or the axes are out of range. O(1). */
RLVC_API uint32_t rlvc_vision_dimensions(const rlvc_vision_config *config);

/* The name of a descriptor, as files have it: "invariants", "sqrt-invariants", "sift-upright",
 * "sift", "orb", "quarters"; null for a value that is none. O(1). */
RLVC_API const char *rlvc_descriptor_name(uint32_t descriptor);

/* The descriptor of a name. O(1).
 * @return RLVC_VISION_OK; RLVC_VISION_E_RANGE (no such name), *descriptor unchanged. */
RLVC_API rlvc_vision_status rlvc_descriptor_named(const char *name, uint32_t *descriptor);

/* D of a descriptor; 0 for a value that is none. O(1). */
RLVC_API uint32_t rlvc_descriptor_dimensions(uint32_t descriptor);

/* ------------------------------------------------------------------------------------ percept */

/* The record that the core keeps, in the machine's own byte order; its size is fixed by P, D (or
 * config.axes in its place), the form and the places, and is a multiple of 4:
 *
 *     float form    uint32_t count; float  vector[P][D];
 *     int8 form     uint32_t count; int8_t vector[P][D]; zeros up to a multiple of 4
 *     points        then int16_t x, y of each of the P, in pixels, low byte first
 *     directed      then int8_t c, s of each of the P: 127 cos and 127 sin of its direction,
 * clockwise on the screen; zeros up to a multiple of 4
 *
 * The count points of the picture, count in [0, P], stand strongest first, and all behind them is
 * 0, so that equal percepts are equal bytes. A picture may have no point at all: count is 0, and
 * such a percept exhibits no feature. Every number is finite. */
#define RLVC_PERCEPT_BYTES_FLOAT(points, dimensions)                                               \
    (4u + 4u * (uint32_t)(points) * (uint32_t)(dimensions))
#define RLVC_PERCEPT_BYTES_INT8(points, dimensions)                                                \
    (4u + ((uint32_t)(points) * (uint32_t)(dimensions) + 3u) / 4u * 4u)
#define RLVC_PERCEPT_BYTES_PLACES(points, places)                                                  \
    ((places) == RLVC_PLACES_NONE     ? 0u                                                         \
     : (places) == RLVC_PLACES_POINTS ? 4u * (uint32_t)(points)                                    \
                                      : (6u * (uint32_t)(points) + 3u) / 4u * 4u)

/* The same for a config; 0 if its descriptor, points, form or places are out of range. At most
 * 2^20, which is the core's limit. O(1). */
RLVC_API uint32_t rlvc_vision_percept_bytes(const rlvc_vision_config *config);

/* Where a vector of a percept was found. Only people need this: the core does not. */
typedef struct rlvc_point {
    float x, y;     /* pixels; the centre of the upper left pixel is (0, 0) */
    float response; /* H, greater than 0 */
} rlvc_point;

/* ------------------------------------------------------------------------------------ picture */

/* picture.format: 8 bits a channel. Values are pinned. */
#define RLVC_PICTURE_GREY 0u /* 1 byte a pixel; colour descriptors see R = G = B */
#define RLVC_PICTURE_BGR 1u  /* 3 bytes a pixel, blue first, as OpenCV has it */
#define RLVC_PICTURE_RGB 2u  /* 3 bytes a pixel, red first */

#define RLVC_PICTURE_SIDE_MAX 32767u

/* A picture in the caller's memory; nothing of it is kept. */
typedef struct rlvc_picture {
    const uint8_t *pixels; /* the upper left pixel */
    ptrdiff_t stride; /* bytes from a row to the one below it, at least a row's in size; negative
                              if the rows lie bottom up. Of no meaning if height is 1 */
    uint32_t width;   /* pixels, [1, RLVC_PICTURE_SIDE_MAX] */
    uint32_t height;  /* likewise */
    uint32_t format;  /* RLVC_PICTURE_* */
} rlvc_picture;

/* ------------------------------------------------------------------------------------ metric */

/* What is known of the vectors of one descriptor: a mean m and a matrix W, so that W (v - m) is
 * what stands in a percept; tau, the radius within which two such vectors count as the same
 * feature; and the step of the int8 form. It also knows the config it was fitted with, and is
 * refused by an extractor whose descriptor, sigma, normalise or axes differ. */
typedef struct rlvc_metric rlvc_metric;

/* How a metric was fitted. Values are pinned.
 *
 * - PLAIN: no whitening, tau and step alone. For SIFT, ORB and QUARTERS.
 * - COVARIANCE: W^T W is the inverse covariance of all vectors (Mahalanobis's distance).
 * - CHANGE: ... of the change of a point's vector between two pictures of the same, so that what
 *   varies by itself weighs little.
 * - DISCRIMINANT: likewise, and turned so that the first axes are those along which vectors differ
 *   most (Fisher's linear discriminants). A few of them tell things apart better than all, and
 *   faster: config.axes. */
#define RLVC_METRIC_PLAIN 0u
#define RLVC_METRIC_COVARIANCE 1u
#define RLVC_METRIC_CHANGE 2u
#define RLVC_METRIC_DISCRIMINANT 3u

/* tau: a percept exhibits a feature if one of its vectors is at most this far from it, in units of
 * the float form; over rlvc_extractor_step it is in units of the percept. > 0. O(1). */
RLVC_API float rlvc_metric_tau(const rlvc_metric *metric);

/* The config that it was fitted with: enough to make the extractor that fits it. O(1). */
RLVC_API void rlvc_metric_config(const rlvc_metric *metric, rlvc_vision_config *config);

/* RLVC_METRIC_*. O(1). */
RLVC_API uint32_t rlvc_metric_kind(const rlvc_metric *metric);

/* Writes the metric as JSON, replacing the file as a whole: it holds the old or the new metric,
 * also after a loss of power. Its permissions are kept. A library leaves signals alone: a program
 * that may meet a limit of a file's size ignores SIGXFSZ, so that the write fails. O(D^2).
 * @return RLVC_VISION_OK; RLVC_VISION_E_FILE: also if it is a link, a FIFO, a device or
 *         write-protected. */
RLVC_API rlvc_vision_status rlvc_metric_save(const rlvc_metric *metric, const char *path,
                                             rlvc_vision_error *error);

/* Reads what rlvc_metric_save wrote; all of it is checked. *metric becomes a new object. O(D^2).
 * @return RLVC_VISION_OK; RLVC_VISION_E_FILE; RLVC_VISION_E_FORMAT. */
RLVC_API rlvc_vision_status rlvc_metric_load(const char *path, rlvc_metric **metric,
                                             rlvc_vision_error *error);

/* The same text, to keep it inside something else. Sets *bytes to its length, and copies it if
 * room is at least that; no 0 is added. text may be null if room is 0.
 * @return RLVC_VISION_OK; RLVC_VISION_E_ROOM: room is too small, *bytes is set, nothing copied. */
RLVC_API rlvc_vision_status rlvc_metric_write(const rlvc_metric *metric, char *text, size_t room,
                                              size_t *bytes, rlvc_vision_error *error);

/* The metric of such a text. *metric becomes a new object.
 * @return RLVC_VISION_OK; RLVC_VISION_E_FORMAT. */
RLVC_API rlvc_vision_status rlvc_metric_read(const char *text, size_t bytes, rlvc_metric **metric,
                                             rlvc_vision_error *error);

/* Frees a metric; null is allowed. Extractors made with it live on. */
RLVC_API void rlvc_metric_destroy(rlvc_metric *metric);

/* ------------------------------------------------------------------------------------ extractor */

typedef struct rlvc_extractor rlvc_extractor;

/* Makes an extractor. Config and metric are copied.
 * @param metric optional; without one, vectors are as the descriptor has them. The int8 form of the
 *               colour invariants needs one, as only it makes their numbers comparable.
 * @return RLVC_VISION_OK; RLVC_VISION_E_CONFIG; RLVC_VISION_E_DESCRIPTOR; RLVC_VISION_E_METRIC. */
RLVC_API rlvc_vision_status rlvc_extractor_create(const rlvc_vision_config *config,
                                                  const rlvc_metric *metric,
                                                  rlvc_extractor **extractor,
                                                  rlvc_vision_error *error);

/* Fills a percept's record from a picture. Pictures of any sizes may follow each other; memory for
 * the widest so far is kept. O(width * height), for the points; the colour invariants add O(P).
 * @param percept the record, aligned to 4.
 * @param percept_bytes its size: rlvc_vision_percept_bytes of the config.
 * @param points optional, [config.points]: the first count of them are filled.
 * @return RLVC_VISION_OK; RLVC_VISION_E_PICTURE; RLVC_VISION_E_ROOM (percept_bytes). */
RLVC_API rlvc_vision_status rlvc_extractor_extract(rlvc_extractor *extractor,
                                                   const rlvc_picture *picture, void *percept,
                                                   size_t percept_bytes, rlvc_point *points,
                                                   rlvc_vision_error *error);

/* What one step of the percept's numbers is worth: 1 in the float form; in the int8 form the
 * metric's step, or the descriptor's own: 1/512 for SIFT, whose numbers stand there minus 1/4
 * (nothing is lost but that 0 becomes 1/512), 1/16 for ORB, and 1 for QUARTERS, minus 128. O(1). */
RLVC_API float rlvc_extractor_step(const rlvc_extractor *extractor);

/* Frees an extractor; null is allowed. */
RLVC_API void rlvc_extractor_destroy(rlvc_extractor *extractor);

/* ------------------------------------------------------------------------------------ fitter */

/* Collects the vectors of many pictures and fits metrics to them. */
typedef struct rlvc_fitter rlvc_fitter;

/* Makes a fitter for a config; its form is of no meaning here.
 * @return RLVC_VISION_OK; RLVC_VISION_E_CONFIG. */
RLVC_API rlvc_vision_status rlvc_fitter_create(const rlvc_vision_config *config,
                                               rlvc_fitter **fitter, rlvc_vision_error *error);

/* Adds a picture of an object: its vectors count for the covariance, the step and tau.
 * @param object any number. Pictures of one object are not asked whether they exhibit each other's
 *               features when tau is sought; a caller who knows no objects gives each picture a
 *               number of its own.
 * @return RLVC_VISION_OK; RLVC_VISION_E_PICTURE; RLVC_VISION_E_RANGE (2^20 vectors are held). */
RLVC_API rlvc_vision_status rlvc_fitter_add(rlvc_fitter *fitter, const rlvc_picture *picture,
                                            uint32_t object, rlvc_vision_error *error);

/* rlvc_fitter_pair's `how`. Values are pinned.
 *
 * - COPIES: the second is the first with other light, noise or the like. A point's partner is the
 *   same place, so both are of one size.
 * - VIEWS: two neighbouring views. A point's partner is the one whose vector is nearest, both ways,
 *   among those within an eighth of the picture's longer side. */
#define RLVC_PAIR_COPIES 0u
#define RLVC_PAIR_VIEWS 1u

/* Adds two pictures of the same: the changes from the points' vectors in `before` to those of their
 * partners in `after` count for RLVC_METRIC_CHANGE and _DISCRIMINANT, and for nothing else.
 * @return RLVC_VISION_OK; RLVC_VISION_E_PICTURE; RLVC_VISION_E_RANGE (how, or as above). */
RLVC_API rlvc_vision_status rlvc_fitter_pair(rlvc_fitter *fitter, const rlvc_picture *before,
                                             const rlvc_picture *after, uint32_t how,
                                             rlvc_vision_error *error);

/* Fits a metric to what was added; more may be added and fitted later. *metric becomes a new
 * object. The order in which pictures were added is of no consequence, but for rounding.
 * @param kind RLVC_METRIC_*.
 * @param share tau is such that of the pictures of other objects this share exhibits a feature, on
 *              average over the features of all pictures (a fixed choice of them if they are many),
 *              (0, 1). 0.2 served well: a tree needs features that are stable more than rare ones.
 * @return RLVC_VISION_OK; RLVC_VISION_E_RANGE (kind, share; another kind than DISCRIMINANT although
 *         config.axes is not 0); RLVC_VISION_E_FEW (fewer than two
 *         objects, or no vector; or not more vectors or changes than dimensions, where they are
 *         needed). */
RLVC_API rlvc_vision_status rlvc_fitter_fit(rlvc_fitter *fitter, uint32_t kind, float share,
                                            rlvc_metric **metric, rlvc_vision_error *error);

/* Frees a fitter; null is allowed. Metrics that it fitted live on. */
RLVC_API void rlvc_fitter_destroy(rlvc_fitter *fitter);

#ifdef __cplusplus
}
#endif

#endif
