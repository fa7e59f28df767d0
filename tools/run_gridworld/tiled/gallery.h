// SPDX-License-Identifier: MIT
// The percepts of all views of all objects, made once before learning.
#ifndef RUN_GRIDWORLD_TILED_GALLERY_H
#define RUN_GRIDWORLD_TILED_GALLERY_H

#include "pictures.h"

#include "rlvc/bags.h"
#include "rlvc/spatial.h"
#include "rlvc/vision.h"

#include <functional>
#include <memory>

// A picture as the agent sees it.
struct Sight {
    uint32_t object = 0;
    int angle = 0;
    std::vector<uint32_t> percept; // the record, in whole words for alignment
    std::vector<rlvc_point> points;
};

// Where a vector comes from.
struct Place {
    uint32_t object;
    int angle;
    rlvc_point point;
};

// The picture that has most of a bag, and which points of it are like vectors of the bag.
struct BagPlace {
    uint32_t object = 0;
    int angle = 0;
    uint32_t count = 0;  // vectors of the bag
    double needed = 0.0; // how many of them are enough, if they are found exactly
    std::vector<rlvc_point> points;
};

class Gallery {
  public:
    // Throws Failure. Fits the metric, or loads it, and extracts every picture.
    Gallery(const TiledOptions &options, std::vector<Object> objects,
            const std::function<void(const std::string &)> &progress);

    const std::vector<Object> &objects() const {
        return objects_;
    }

    // The pictures of an object to learn from, and its held-out pictures.
    const std::vector<Sight> &seen(uint32_t object) const {
        return seen_[object];
    }
    const std::vector<Sight> &held_out(uint32_t object) const {
        return held_out_[object];
    }

    const rlvc_descriptors &descriptors() const {
        return bags_on_ ? bags_.vectors : spatial_.vectors;
    }
    // The domain of pairs, if there are any, else null.
    const rlvc_spatial *spatial() const {
        return config_.places == RLVC_PLACES_NONE ? nullptr : &spatial_;
    }

    // Are features bags?
    bool bags() const {
        return bags_on_;
    }

    // The domain of these percepts; it points into the gallery.
    rlvc_domain domain();

    // Where the vector of a feature comes from; null if from no picture to learn from, or if the
    // feature is a bag.
    const Place *find(const void *feature) const;
    // Likewise the second vector of a pair; null also if the feature is none.
    const Place *find_second(const void *feature) const;
    // Where most of a bag is seen, among one picture of each view to learn from.
    BagPlace find_bag(const void *feature) const;

    double tau() const {
        return double{tau_};
    }
    double milliseconds() const { // for each picture, to make its percept
        return milliseconds_;
    }

  private:
    void prepare(const TiledOptions &options);
    void make_domain(const TiledOptions &options);
    void extract(const TiledOptions &options,
                 const std::function<void(const std::string &)> &progress);
    Sight look(uint32_t object, int angle, const cv::Mat &picture);
    void index(const Sight &sight);
    const char *first_vector(const void *feature) const;
    const Place *find_vector(const void *vector) const;
    double score(const Sight &sight, const void *feature, std::vector<rlvc_point> &points) const;

    std::vector<Object> objects_;
    std::vector<std::vector<Sight>> seen_, held_out_;
    rlvc_vision_config config_{};
    std::unique_ptr<rlvc_metric, void (*)(rlvc_metric *)> metric_;
    std::unique_ptr<rlvc_extractor, void (*)(rlvc_extractor *)> extractor_;
    rlvc_spatial spatial_{};
    rlvc_bags bags_{};
    bool bags_on_;
    std::size_t views_;                   // pictures of an object that are not copies of others
    std::map<std::string, Place> places_; // by the bytes of the vector
    float tau_ = 0.0f;
    double milliseconds_ = 0.0;
};

#endif
