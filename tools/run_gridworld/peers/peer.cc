// SPDX-License-Identifier: MIT
#include "peer.h"

#include "model.h"
#include "tabular.h"

std::unique_ptr<Peer> make_peer(const PeerOptions &options) {
    if (options.kind == LearnerKind::told_r_max ||
        options.kind == LearnerKind::told_value_iteration) {
        return std::make_unique<ModelPeer>(options);
    }
    return std::make_unique<TabularPeer>(options);
}
