#include "model/generators/generated_motions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "model/generators/generator_file.hpp"
#include "model/nn/blas.hpp"
#include "model/nn/one_line.hpp"
#include "model/train/torch_device.hpp"

namespace actformer::model {
namespace {

/// A generator that is ready, and what is asked of it.
struct Loaded {
    GeneratorFile file;
    std::shared_ptr<Maker> maker;
    std::vector<std::uint32_t> labels, counts;  ///< classes, and motions of each
    std::uint32_t made_frames = 0, frames = 0;  ///< frames: what is left of made_frames
    std::string source;
};

class GeneratedMotions final : public eval::MotionSource {
  public:
    GeneratedMotions(std::shared_ptr<const Loaded> loaded, std::uint64_t seed)
        : loaded_(std::move(loaded)), seed_(seed) {
        const auto& subjects = loaded_->file.subjects;
        info_.source = loaded_->source;
        info_.representation = subjects.representation;
        info_.classes = subjects.classes;
        info_.persons = subjects.persons;
        info_.body = subjects;
        info_.channels = subjects.persons * subjects.representation.numbers();
        info_.joints = subjects.representation.nodes(subjects.topology);
        info_.parents = subjects.representation.node_parents(subjects.topology);
        info_.shortest = info_.longest = loaded_->frames;
        info_.fingerprint = fmt::format("{}|{}", loaded_->file.checksum, seed);
        info_.view = loaded_->frames == loaded_->made_frames
                         ? "whole motions"
                         : fmt::format("first {} frames", loaded_->frames);
        list();
    }

    const eval::MotionsInfo& info() const override { return info_; }
    eval::MotionBatch next() override;

  private:
    void list();

    std::shared_ptr<const Loaded> loaded_;
    std::uint64_t seed_;
    eval::MotionsInfo info_;
    std::vector<std::uint64_t> rows_;  ///< of each motion as it is made, class by class
    std::size_t class_ = 0;            ///< of the next batch, among Loaded::labels
    std::uint32_t first_ = 0;          ///< of the next batch, within its class
    std::size_t made_ = 0;             ///< motions of all batches so far
    std::vector<float> values_;        ///< of the last batch
};

/// Rows follow the names in the order in which a file has them: A001_10 before A001_2.
void GeneratedMotions::list() {
    std::vector<std::string> made;
    std::vector<std::uint32_t> labels;
    for (std::size_t c = 0; c < loaded_->labels.size(); ++c)
        for (std::uint32_t i = 0; i < loaded_->counts[c]; ++i) {
            made.push_back(fmt::format("A{:03}_{}", loaded_->labels[c] + 1, i));
            labels.push_back(loaded_->labels[c]);
        }
    std::vector<std::size_t> order(made.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return made[a] < made[b]; });
    rows_.resize(made.size());
    for (std::size_t row = 0; row < order.size(); ++row) {
        rows_[order[row]] = row;
        info_.names.push_back(made[order[row]]);
        info_.labels.push_back(labels[order[row]]);
    }
}

eval::MotionBatch GeneratedMotions::next() try {
    if (class_ == loaded_->labels.size()) return {};
    const auto whole = loaded_->maker->batch();
    const auto count = std::min(whole, loaded_->counts[class_] - first_);
    const auto made =
        loaded_->maker->make(seed_, loaded_->labels[class_], first_ / whole, loaded_->made_frames);
    const std::size_t frame = info_.joints, frames = loaded_->made_frames;
    values_.clear();
    for (std::size_t channel = 0; channel < std::size_t{count} * info_.channels; ++channel) {
        const auto first = made.begin() + static_cast<std::ptrdiff_t>(channel * frames * frame);
        values_.insert(values_.end(), first, first + static_cast<std::ptrdiff_t>(loaded_->frames * frame));
    }
    eval::MotionBatch batch;
    const auto row = rows_.begin() + static_cast<std::ptrdiff_t>(made_);
    batch.rows.assign(row, row + count);
    if (!std::ranges::all_of(values_, [](float v) { return std::isfinite(v); }))
        throw Error("{}: motions such as '{}' hold numbers that are not finite; take earlier weights",
                    info_.source, info_.names[batch.rows[0]]);
    batch.frames = loaded_->frames;
    batch.values = values_;
    made_ += count;
    first_ += count;
    if (first_ == loaded_->counts[class_]) {
        first_ = 0;
        ++class_;
    }
    return batch;
} catch (const c10::Error& e) {
    throw Error("libtorch: {}", one_line(e));
}

std::string counts_of(const eval::GeneratedRequest& request) {
    return request.counts.empty() ? std::to_string(request.per_class)
                                  : fmt::format("{}", fmt::join(request.counts, ","));
}

Loaded load(const eval::GeneratedRequest& request) {
    Loaded loaded{load_generator(request.generator),
                  {},
                  request.labels,
                  request.counts,
                  0,
                  request.frames,
                  request.generator};
    const auto device = request.device.empty() ? "cpu" : request.device;
    torch_device(device, "--generate-on ");
    loaded.maker = loaded.file.maker(device);
    const auto classes = loaded.file.subjects.classes.size();
    if (loaded.labels.empty()) {
        loaded.labels.resize(classes);
        std::iota(loaded.labels.begin(), loaded.labels.end(), 0U);
    }
    for (const auto label : loaded.labels)
        if (label >= classes)
            throw Error(
                "{}: generates {} classes, and the real side has class {}; score on the data that it learnt",
                request.generator, classes, label + 1);
    if (loaded.counts.empty()) loaded.counts.assign(loaded.labels.size(), request.per_class);
    // As `generate` makes them: some methods could make longer ones, whose beginnings are others.
    loaded.made_frames = loaded.file.frames();
    if (loaded.frames > loaded.made_frames)
        throw Error("{}: --frames {}, but its motions have {}; ask for fewer", request.generator,
                    loaded.frames, loaded.made_frames);
    if (loaded.frames == 0) loaded.frames = loaded.made_frames;
    return loaded;
}

}  // namespace

std::vector<eval::MotionSet> generated_sets(const eval::GeneratedRequest& request) try {
    set_threads(0);
    const auto loaded = std::make_shared<const Loaded>(load(request));
    std::vector<eval::MotionSet> sets;
    for (std::uint64_t i = 0; i < request.sets; ++i) {
        const auto seed = request.seed + i;
        eval::MotionSet set;
        set.name = fmt::format("{}, seed {}", request.generator, seed);
        set.key = fmt::format("{}|{}|{}|{}|{}", loaded->file.checksum, seed, counts_of(request),
                              fmt::join(loaded->labels, ","), loaded->frames);
        set.seed = seed;
        set.open = [loaded, seed] { return std::make_unique<GeneratedMotions>(loaded, seed); };
        sets.push_back(std::move(set));
    }
    return sets;
} catch (const c10::Error& e) {
    throw Error("libtorch: {}", one_line(e));
}

}  // namespace actformer::model
