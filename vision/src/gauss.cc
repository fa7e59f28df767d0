// SPDX-License-Identifier: MIT
#include "gauss.h"

#include <cmath>
#include <cstdlib>

namespace rlvc {

Gauss::Gauss(float scale, int reach) : radius(reach) {
    std::vector<double> weight;
    double sum = 0;
    double moment = 0;
    for (int j = 0; j <= reach; j++) {
        const double t = static_cast<double>(j) / static_cast<double>(scale);
        weight.push_back(std::exp(-t * t / 2));
        sum += (j == 0 ? 1 : 2) * weight.back();
        moment += 2.0 * j * j * weight.back();
    }
    for (int j = 0; j <= reach; j++) {
        smooth.push_back(static_cast<float>(weight[static_cast<size_t>(j)] / sum));
        derive.push_back(static_cast<float>(j * weight[static_cast<size_t>(j)] / moment));
    }
}

int mirror(int i, int n) {
    if (i >= 0 && i < n)
        return i;
    if (n == 1)
        return 0;
    const int period = 2 * (n - 1);
    const int turned = std::abs(i) % period;
    return turned < n ? turned : period - turned;
}

} // namespace rlvc
