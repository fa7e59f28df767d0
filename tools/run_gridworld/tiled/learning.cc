// SPDX-License-Identifier: MIT
#include "learning.h"

#include "../check.h"
#include "../interrupt.h"

#include <algorithm>
#include <ctime>
#include <set>

namespace {

constexpr uint32_t slice = 1u << 20; // of learning, between two looks at interrupt_signal()

class Run {
  public:
    Run(const TiledOptions &options, const gridworld_maze &maze, const Optimum &optimum,
        Gallery &gallery, uint32_t seed);

    void collect(uint64_t count);
    void learn();
    TiledRun result();
    uint32_t classes() const;

  private:
    void place_objects();
    const void *see();
    double share(bool held_out);
    void look_up_cells();
    void list_tests();
    std::string print(uint32_t format) const;
    std::string save() const;

    const TiledOptions &options_;
    const gridworld_maze &maze_;
    const Optimum &optimum_;
    Gallery &gallery_;
    rlvc_domain domain_;
    rlvc_config config_{};
    uint32_t classes_max_;
    std::unique_ptr<uint64_t[]> memory_;
    rlvc_agent *agent_ = nullptr;
    gridworld world_{};
    std::mt19937 random_;
    const void *percept_ = nullptr;
    TiledRun result_;
};

uint32_t classes_for(const TiledOptions &options, const gridworld_maze &maze) {
    return options.classes != 0 ? options.classes : std::min(4u * maze.free_cells + 16u, 65535u);
}

Run::Run(const TiledOptions &options, const gridworld_maze &maze, const Optimum &optimum,
         Gallery &gallery, uint32_t seed)
    : options_(options), maze_(maze), optimum_(optimum), gallery_(gallery),
      domain_(gallery.domain()), classes_max_(classes_for(options, maze)), random_(seed) {
    check(rlvc_config_default(&config_, &domain_, GRIDWORLD_ACTIONS), "rlvc_config_default");
    config_.capacity = options.interactions;
    config_.classes = classes_max_;
    config_.seed = seed;
    config_.criterion = options.criterion;
    if (options.criterion == RLVC_CRITERION_RETURNS) { // as published
        config_.continuing = 1;
        config_.explore = RLVC_EXPLORE_UNIFORM;
    }
    config_.discount = options.gamma;
    config_.epsilon = options.epsilon;
    config_.alpha = options.alpha;
    config_.alpha_known = options.alpha;
    const char *why = nullptr;
    if (rlvc_config_check(&config_, &domain_, &why) != RLVC_OK) {
        throw Failure(std::string("impossible options: ") + why);
    }
    std::size_t bytes = 0;
    check(rlvc_agent_size(&config_, &domain_, &bytes), "rlvc_agent_size");
    memory_.reset(new uint64_t[bytes / sizeof(uint64_t) + 1]);
    check(rlvc_agent_init(&config_, &domain_, memory_.get(), bytes, &agent_), "rlvc_agent_init");
    result_.seed = seed;
    result_.memory_bytes = bytes;
    place_objects();
    gridworld_init(&world_, &maze, 0, 0.0f, seed);
    percept_ = see();
    check(rlvc_begin(agent_, percept_), "rlvc_begin");
}

// Each run has other objects in other cells.
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
        rlvc_choice choice;
        float reward = 0.0f;
        check(rlvc_act(agent_, &choice), "rlvc_act");
        const bool over = gridworld_step(&world_, choice.action, &reward) == 1;
        if (over) {
            check(rlvc_observe(agent_, choice, reward, nullptr, RLVC_TERMINATED), "rlvc_observe");
            gridworld_reset(&world_);
            percept_ = see();
            check(rlvc_begin(agent_, percept_), "rlvc_begin");
        } else {
            percept_ = see();
            check(rlvc_observe(agent_, choice, reward, percept_, RLVC_GOES_ON), "rlvc_observe");
        }
        result_.interactions++;
    }
}

void Run::learn() {
    const std::clock_t start = std::clock(); // whatever else runs on the machine does not count
    rlvc_progress progress;
    do {
        if (interrupt_signal() != 0) {
            throw Interrupted(std::to_string(result_.interactions) +
                              " interactions of the run with seed " + std::to_string(result_.seed));
        }
        check(rlvc_learn(agent_, slice, &progress), "rlvc_learn");
    } while (!progress.done);
    result_.seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

uint32_t Run::classes() const {
    rlvc_statistics statistics;
    check(rlvc_stats(agent_, &statistics), "rlvc_stats");
    if (statistics.refused > 0) {
        throw Failure("the tree is full: its " + std::to_string(statistics.classes) +
                      " classes did not suffice: allow more with --classes");
    }
    return statistics.classes;
}

// The share of the pictures whose action is optimal in their cell.
double Run::share(bool held_out) {
    uint64_t right = 0, all = 0;
    for (uint32_t cell = 0; cell < result_.object.size(); cell++) {
        if (maze_.cells[cell] != GRIDWORLD_FREE) {
            continue;
        }
        const uint32_t object = result_.object[cell];
        for (const Sight &sight : held_out ? gallery_.held_out(object) : gallery_.seen(object)) {
            uint32_t action = 0;
            check(rlvc_predict(agent_, sight.percept.data(), nullptr, &action), "rlvc_predict");
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
        if (maze_.cells[cell] != GRIDWORLD_FREE) {
            continue;
        }
        std::set<uint32_t> classes, actions;
        bool optimal = true;
        for (const Sight &sight : gallery_.seen(result_.object[cell])) {
            uint32_t class_id = 0, action = 0;
            check(rlvc_predict(agent_, sight.percept.data(), &class_id, &action), "rlvc_predict");
            classes.insert(class_id);
            actions.insert(action);
            optimal = optimal && optimum_.optimal(cell, action);
        }
        CellPolicy &here = result_.policy.cells[cell];
        here.optimal = optimal;
        if (classes.size() == 1) {
            here.class_id = *classes.begin();
        }
        if (actions.size() == 1) {
            here.action = *actions.begin();
        }
        result_.optimal_cells += optimal;
        result_.classes_of_cell[cell].assign(classes.begin(), classes.end());
    }
    result_.policy.optimal = result_.optimal_cells;
}

void Run::list_tests() {
    std::vector<unsigned char> feature(domain_.feature_bytes);
    for (uint32_t j = 0; j + 1 < result_.classes; j++) {
        char name[RLVC_NAME_BYTES];
        rlvc_split split;
        check(rlvc_split_at(agent_, j, &split, feature.data()), "rlvc_split_at");
        domain_.name(domain_.ctx, feature.data(), name, sizeof name);
        Test test;
        test.split_class = split.class_id;
        test.step = split.step;
        test.radius = rlvc_descriptors_radius(feature.data());
        test.name = name;
        test.place = gallery_.find(feature.data());
        result_.tests.push_back(test);
    }
}

std::string Run::print(uint32_t format) const {
    std::string all;
    const rlvc_write append = [](void *ctx, const char *text, std::size_t bytes) {
        static_cast<std::string *>(ctx)->append(text, bytes);
        return 0;
    };
    check(rlvc_print(agent_, format, append, &all), "rlvc_print");
    return all;
}

// In the first of two slots.
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
    check(rlvc_save(agent_, &store), "rlvc_save");
    rlvc_snapshot_info info;
    check(rlvc_snapshot_peek(&store, &info), "rlvc_snapshot_peek");
    return slots.substr(0, info.bytes);
}

TiledRun Run::result() {
    rlvc_statistics statistics;
    check(rlvc_stats(agent_, &statistics), "rlvc_stats");
    result_.classes = statistics.classes;
    result_.depth = statistics.depth;
    result_.optimal_seen = share(false);
    result_.optimal_heldout = share(true);
    look_up_cells();
    list_tests();
    result_.tree_json = print(RLVC_PRINT_JSON);
    result_.tree_dot = print(RLVC_PRINT_DOT);
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
    const bool returns = options.criterion == RLVC_CRITERION_RETURNS;
    uint64_t collected = 0;
    for (uint32_t k = 0; k < options.steps; k++) {
        const uint64_t all = uint64_t{options.interactions} * (k + 1);
        const uint64_t wanted = returns ? all : all / options.steps;
        run.collect(wanted - collected);
        collected = wanted;
        run.learn();
        listener("step " + std::to_string(k + 1) + " of " + std::to_string(options.steps) + ": " +
                 std::to_string(wanted) + " interactions, " + std::to_string(run.classes()) +
                 " classes");
    }
    return run.result();
}
