// SPDX-License-Identifier: MIT
#include "learner.h"

#include "../cli/interrupt.h"
#include "../maze/agent.h"

#include <algorithm>
#include <ctime>
#include <set>

namespace {

rlvc_config make_config(const TiledOptions &options, const gridworld_maze &maze,
                        const rlvc_domain &domain, uint32_t seed) {
    rlvc_config config = ::make_config(options, domain, seed);
    config.capacity = options.interactions;
    config.classes =
        options.classes != 0 ? options.classes : std::min(4u * maze.free_cells + 16u, 65535u);
    config.alpha_known = options.alpha;
    return config;
}

class Run {
  public:
    Run(const TiledOptions &options, const gridworld_maze &maze, const Optimum &optimum,
        Gallery &gallery, uint32_t seed);

    void collect(uint64_t count);
    void learn();
    TiledRun result();
    uint32_t classes() const {
        return agent_.statistics().classes;
    }

  private:
    void place_objects();
    const void *see();
    double optimal_share(bool held_out);
    void look_up_cells();
    void look_up_cell(uint32_t cell);
    void list_tests();
    std::string save() const;

    const TiledOptions &options_;
    const gridworld_maze &maze_;
    const Optimum &optimum_;
    Gallery &gallery_;
    const rlvc_domain domain_;
    const rlvc_config config_;
    Agent agent_;
    gridworld world_{};
    std::mt19937 random_;
    TiledRun result_;
};

Run::Run(const TiledOptions &options, const gridworld_maze &maze, const Optimum &optimum,
         Gallery &gallery, uint32_t seed)
    : options_(options), maze_(maze), optimum_(optimum), gallery_(gallery),
      domain_(gallery.domain()), config_(make_config(options, maze, domain_, seed)),
      agent_(config_, domain_), random_(seed) {
    result_.seed = seed;
    result_.memory_bytes = agent_.bytes();
    place_objects();
    gridworld_init(&world_, &maze, 0, 0.0f, seed);
    agent_.begin([this] { return see(); });
}

// Each run places the objects in other cells.
void Run::place_objects() {
    std::vector<uint32_t> order(gallery_.objects().size());
    for (uint32_t i = 0; i < order.size(); i++) {
        order[i] = i;
    }
    for (uint32_t i = static_cast<uint32_t>(order.size()); i > 1; i--) {
        std::swap(order[i - 1], order[random_() % i]); // std::shuffle differs between libraries
    }
    uint32_t next = 0;
    result_.object.resize(std::size_t{maze_.width} * maze_.height);
    for (uint32_t cell = 0; cell < result_.object.size(); cell++) {
        if (maze_.cells[cell] == GRIDWORLD_FREE) {
            result_.object[cell] = order[next++];
        }
    }
    result_.cells = next;
}

const void *Run::see() {
    const std::vector<Sight> &sights = gallery_.seen(result_.object[world_.cell]);
    return sights[random_() % sights.size()].percept.data();
}

void Run::collect(uint64_t count) {
    for (uint64_t i = 0; i < count; i++) {
        agent_.interact(world_, [this] { return see(); });
        result_.interactions++;
    }
}

void Run::learn() {
    const std::clock_t start = std::clock(); // of this process only
    const auto look_for_interrupt = [this] {
        if (interrupt_signal() != 0) {
            throw Interrupted(std::to_string(result_.interactions) +
                              " interactions of the run with seed " + std::to_string(result_.seed) +
                              "; nothing was written");
        }
    };
    agent_.learn(look_for_interrupt, "in the run with seed " + std::to_string(result_.seed));
    result_.seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// The share of the pictures whose action is optimal in their cell.
double Run::optimal_share(bool held_out) {
    uint64_t right = 0, all = 0;
    for (uint32_t cell = 0; cell < result_.object.size(); cell++) {
        if (maze_.cells[cell] != GRIDWORLD_FREE) {
            continue;
        }
        const uint32_t object = result_.object[cell];
        for (const Sight &sight : held_out ? gallery_.held_out(object) : gallery_.seen(object)) {
            uint32_t action = 0;
            check(rlvc_predict(agent_.get(), sight.percept.data(), nullptr, &action),
                  "rlvc_predict");
            right += optimum_.optimal(cell, action);
            all++;
        }
    }
    return static_cast<double>(right) / static_cast<double>(all);
}

void Run::look_up_cells() {
    result_.policy.cells.resize(result_.object.size());
    result_.classes_of_cell.resize(result_.object.size());
    for (uint32_t cell = 0; cell < result_.object.size(); cell++) {
        if (maze_.cells[cell] == GRIDWORLD_FREE) {
            look_up_cell(cell);
        }
    }
    result_.policy.optimal = result_.optimal_cells;
}

void Run::look_up_cell(uint32_t cell) {
    std::set<uint32_t> classes, actions;
    CellPolicy &policy = result_.policy.cells[cell];
    policy.optimal = true;
    for (const Sight &sight : gallery_.seen(result_.object[cell])) {
        uint32_t class_id = 0, action = 0;
        check(rlvc_predict(agent_.get(), sight.percept.data(), &class_id, &action), "rlvc_predict");
        classes.insert(class_id);
        actions.insert(action);
        policy.optimal = policy.optimal && optimum_.optimal(cell, action);
    }
    if (classes.size() == 1) {
        policy.class_id = *classes.begin();
    }
    if (actions.size() == 1) {
        policy.action = *actions.begin();
    }
    result_.optimal_cells += policy.optimal;
    result_.classes_of_cell[cell].assign(classes.begin(), classes.end());
}

void Run::list_tests() {
    std::vector<unsigned char> feature(domain_.feature_bytes);
    for (uint32_t j = 0; j + 1 < result_.classes; j++) {
        char name[RLVC_NAME_BYTES];
        rlvc_split split;
        check(rlvc_split_at(agent_.get(), j, &split, feature.data()), "rlvc_split_at");
        domain_.name(domain_.ctx, feature.data(), name, sizeof name);
        Test test;
        test.split_class = split.class_id;
        test.step = split.step;
        test.name = name;
        if (gallery_.bags()) {
            test.bag = gallery_.find_bag(feature.data());
        } else {
            test.radius = rlvc_descriptors_radius(feature.data());
        }
        test.place = gallery_.find(feature.data());
        test.second = gallery_.find_second(feature.data());
        result_.tests.push_back(test);
    }
}

// The snapshot, from the first of two slots.
std::string Run::save() const {
    std::string slots;
    rlvc_store store{};
    store.ctx = &slots;
    store.read = [](void *ctx, uint32_t offset, void *buffer, uint32_t bytes) {
        static_cast<std::string *>(ctx)->copy(static_cast<char *>(buffer), bytes, offset);
        return 0;
    };
    store.write = [](void *ctx, uint32_t offset, const void *buffer, uint32_t bytes) {
        static_cast<std::string *>(ctx)->replace(offset, bytes, static_cast<const char *>(buffer),
                                                 bytes);
        return 0;
    };
    check(rlvc_snapshot_size(&config_, &domain_, &store.slot_bytes), "rlvc_snapshot_size");
    slots.resize(std::size_t{2} * store.slot_bytes);
    check(rlvc_save(agent_.get(), &store), "rlvc_save");
    rlvc_snapshot_info info;
    check(rlvc_snapshot_peek(&store, &info), "rlvc_snapshot_peek");
    return slots.substr(0, info.bytes);
}

TiledRun Run::result() {
    const rlvc_statistics statistics = agent_.statistics();
    result_.classes = statistics.classes;
    result_.depth = statistics.depth;
    result_.optimal_seen = optimal_share(false);
    result_.optimal_heldout = optimal_share(true);
    look_up_cells();
    list_tests();
    result_.tree_json = agent_.print(RLVC_PRINT_JSON);
    result_.tree_dot = agent_.print(RLVC_PRINT_DOT);
    if (!options_.snapshot.empty()) {
        result_.snapshot = save();
    }
    return result_;
}

} // namespace

TiledRun learn_tiled(const TiledOptions &options, const gridworld_maze &maze,
                     const Optimum &optimum, Gallery &gallery, uint32_t seed,
                     const TiledListener &listener) {
    Run run(options, maze, optimum, gallery, seed);
    uint64_t collected = 0;
    for (uint32_t k = 0; k < options.steps; k++) {
        const uint64_t wanted = interactions_until(options, k);
        run.collect(wanted - collected);
        collected = wanted;
        run.learn();
        listener("step " + std::to_string(k + 1) + " of " + std::to_string(options.steps) + ": " +
                 std::to_string(wanted) + " interactions, " + std::to_string(run.classes()) +
                 " classes");
    }
    return run.result();
}
