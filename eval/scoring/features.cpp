#include "eval/scoring/features.hpp"

#include <algorithm>

#include "eval/scoring/features_file.hpp"

namespace actformer::eval {
namespace {

/// A target's file in the making.
class Output {
  public:
    Output(const FeaturesTarget& target, const MotionsInfo& motions)
        : extractor_(*target.extractor),
          motions_(motions),
          file_(target.file, motions.names.size(), extractor_.features(), extractor_.classes()) {
        extractor_.begin_set(motions);
    }

    void add(const MotionBatch& batch) {
        const auto got = extractor_.extract(batch, motions_);
        const auto features = extractor_.features(), classes = extractor_.classes();
        for (std::size_t first = 0; first < batch.rows.size();) {
            const auto rows = neighbours(batch.rows, first);
            file_.add(batch.rows[first], part(got.features, first, rows, features),
                      part(got.logits, first, rows, classes));
            first += rows;
        }
        if (classes == 0 || motions_.labels.empty()) return;
        for (std::size_t i = 0; i < batch.rows.size(); ++i)
            count(part(got.logits, i, 1, classes), motions_.labels[batch.rows[i]]);
    }

    FeaturesSummary finish() {
        file_.names(motions_.names);
        if (!motions_.labels.empty()) file_.labels(motions_.labels);
        file_.frames(motions_.shortest, motions_.longest);
        file_.note("program", "actformer " ACTFORMER_VERSION);
        file_.note("version", ACTFORMER_VERSION);
        file_.note("recogniser", extractor_.checksum());
        file_.note("input", motions_.fingerprint);
        file_.note("view", motions_.view);
        file_.finish();
        FeaturesSummary out{
            motions_.names.size(), extractor_.classes(), extractor_.features(), !motions_.labels.empty(), {}};
        if (counted_ > 0) out.accuracy = static_cast<double>(right_) / static_cast<double>(counted_);
        return out;
    }

  private:
    static std::span<const float> part(const std::vector<float>& values, std::size_t first, std::size_t rows,
                                       std::size_t columns) {
        return std::span(values).subspan(first * columns, rows * columns);
    }
    /// How many rows from `first` on follow one another in the file.
    static std::size_t neighbours(const std::vector<std::uint64_t>& rows, std::size_t first) {
        std::size_t count = 1;
        while (first + count < rows.size() && rows[first + count] == rows[first] + count) ++count;
        return count;
    }
    void count(std::span<const float> logits, std::uint32_t label) {
        const auto largest = std::max_element(logits.begin(), logits.end()) - logits.begin();
        right_ += static_cast<std::uint64_t>(largest) == label;
        ++counted_;
    }

    FeatureExtractor& extractor_;
    const MotionsInfo& motions_;
    FeaturesFile file_;
    std::uint64_t right_ = 0, counted_ = 0;
};

}  // namespace

FeaturesSummary write_features(MotionSource& motions, std::span<const FeaturesTarget> targets,
                               const OnProgress& tell) {
    const auto& info = motions.info();
    for (const auto& target : targets) {
        target.extractor->check_fits(info);
        target.extractor->check_classes(info);
    }
    std::vector<std::unique_ptr<Output>> outputs;
    for (const auto& target : targets) outputs.push_back(std::make_unique<Output>(target, info));
    std::uint64_t done = 0;
    for (auto batch = motions.next(); !batch.rows.empty(); batch = motions.next()) {
        for (auto& output : outputs) output->add(batch);
        done += batch.rows.size();
        if (tell) tell(done, info.names.size());
    }
    FeaturesSummary first;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const auto summary = outputs[i]->finish();
        if (i == 0) first = summary;
    }
    return first;
}

}  // namespace actformer::eval
