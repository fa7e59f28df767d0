// SPDX-License-Identifier: MIT
// The matrix W under which the spread of some vectors becomes the same in all directions.
#ifndef RLVC_VISION_WHITENING_H
#define RLVC_VISION_WHITENING_H

#include <cstddef>
#include <vector>

namespace rlvc {

// The mean of vectors of n numbers, one after another; there is one at least.
std::vector<float> mean_of(const std::vector<float> &vectors, size_t n);

// W [n][n] with W^T W = S^-1, where S is the mean of (v - centre)(v - centre)^T.
//
// S is scaled to a diagonal of 1 first, and eigenvalues of the result below a thousandth (their
// mean is 1) are taken for a thousandth: directions that hardly vary, as of pictures without
// colour, or for want of vectors, must not outweigh all others. A number that never varies is left
// as it is.
std::vector<float> whitening_of(const std::vector<float> &vectors, const std::vector<float> &centre,
                                size_t n);

// W [kept][n]: Fisher's linear discriminants. S, of changes about 0, and T, of vectors about
// `centre`, are the means of the products as above; W S' W^T is the identity and W T W^T diagonal,
// its largest numbers first. S' is S with a part of its mean diagonal number added to all of them:
// directions in which changes were hardly seen are not known to be better.
std::vector<float> discriminants_of(const std::vector<float> &changes,
                                    const std::vector<float> &vectors,
                                    const std::vector<float> &centre, size_t n, size_t kept);

} // namespace rlvc

#endif
