#include "eval/scoring/motions_file_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "base/hdf5/reader.hpp"
#include "ingest/dataset/described_motions.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "ingest/dataset/own_kind.hpp"
#include "ingest/dataset/subjects.hpp"

namespace actformer::eval {
namespace {

namespace fs = std::filesystem;

class MotionsFileSource final : public MotionSource {
  public:
    MotionsFileSource(const fs::path& file, MotionsFileOptions options)
        : options_(std::move(options)), where_(file.string()), file_(file) {
        info_.source = where_;
        info_.view = options_.frames ? fmt::format("first {} frames", options_.frames) : "whole motions";
        ingest::refuse_other_than_motions(file_, where_);
        list();
        describe();
        info_.labels = labels();
        info_.fingerprint = checksum_file(file);
        at_ = by_frames_.begin();
    }

    const MotionsInfo& info() const override { return info_; }
    MotionBatch next() override;

  private:
    void list();
    void describe();
    void check_shape(const hdf5::Shape& shape, const std::string& name);
    std::optional<std::uint32_t> label_of(const std::string& name) const;
    std::vector<std::uint32_t> labels() const;
    void append(const std::string& name, std::uint32_t frames);

    MotionsFileOptions options_;
    std::string where_;
    hdf5::Reader file_;
    MotionsInfo info_;
    std::map<std::uint32_t, std::vector<std::uint64_t>> by_frames_;  ///< rows of each length
    std::map<std::uint32_t, std::vector<std::uint64_t>>::const_iterator at_;
    std::size_t first_ = 0;  ///< of the rows of that length that have not come yet
    std::vector<float> values_;
};

void MotionsFileSource::check_shape(const hdf5::Shape& shape, const std::string& name) {
    if (shape.size() != 3) throw Error("{}: '{}' is no (P*C, K, T) array", where_, name);
    if (info_.names.empty()) {
        info_.channels = static_cast<std::uint32_t>(shape[0]);
        info_.joints = static_cast<std::uint32_t>(shape[1]);
    }
    if (shape[0] != info_.channels || shape[1] != info_.joints)
        throw Error("{}: '{}' has {} channels and {} joints, and '{}' has {} and {}; keep to one kind a file",
                    where_, name, shape[0], shape[1], info_.names[0], info_.channels, info_.joints);
    if (shape[2] == 0) throw Error("{}: '{}' has no frames; leave it out", where_, name);
    if (shape[2] < options_.frames)
        throw Error("{}: '{}' has {} frames, fewer than {}; ask for fewer with --frames", where_, name,
                    shape[2], options_.frames);
}

void MotionsFileSource::list() {
    for (const auto& name : file_.names()) {
        if (!file_.is_array(name)) continue;
        const auto shape = file_.shape(name);
        check_shape(shape, name);
        const auto frames = options_.frames ? options_.frames : static_cast<std::uint32_t>(shape[2]);
        by_frames_[frames].push_back(info_.names.size());
        info_.names.push_back(name);
    }
    if (info_.names.empty())
        throw Error("{}: holds no motions; one (P*C, K, T) array a clip is expected", where_);
    info_.shortest = by_frames_.begin()->first;
    info_.longest = by_frames_.rbegin()->first;
}

/// What the file's attributes tell.
void MotionsFileSource::describe() {
    info_.representation = ingest::read_representation(file_, where_);
    const auto subjects = ingest::read_subjects(file_, where_);
    if (!subjects) return;
    info_.parents = subjects->representation.node_parents(subjects->topology);
    info_.persons = subjects->persons;
    info_.body = *subjects;
    if (options_.labels.empty()) info_.classes = subjects->classes;
}

/// As given, else as the motion's attribute or name tells.
std::optional<std::uint32_t> MotionsFileSource::label_of(const std::string& name) const {
    if (options_.labels.empty()) {
        const auto told = ingest::read_label(file_, name, where_);
        return told ? told : ingest::label_in(name);
    }
    const auto given = options_.labels.find(name);
    if (given == options_.labels.end()) throw Error("{}: '{}' has no line in the labels given", where_, name);
    return given->second;
}

/// None where one of the motions does not tell.
std::vector<std::uint32_t> MotionsFileSource::labels() const {
    std::vector<std::uint32_t> labels;
    for (const auto& name : info_.names) {
        const auto label = label_of(name);
        if (!label) return {};
        labels.push_back(*label);
    }
    return labels;
}

/// A stored (C, K, T) motion's beginning as (C, frames, K).
void MotionsFileSource::append(const std::string& name, std::uint32_t frames) {
    const auto shape = file_.shape(name);
    const auto stored = file_.read<float>(name);
    if (!std::all_of(stored.begin(), stored.end(), [](float v) { return std::isfinite(v); }))
        throw Error("{}: '{}' holds numbers that are not finite", where_, name);
    for (std::size_t c = 0; c < shape[0]; ++c)
        for (std::size_t t = 0; t < frames; ++t)
            for (std::size_t k = 0; k < shape[1]; ++k)
                values_.push_back(stored[(c * shape[1] + k) * shape[2] + t]);
}

MotionBatch MotionsFileSource::next() {
    if (at_ == by_frames_.end()) return {};
    const auto& [frames, rows] = *at_;
    const auto count = std::min<std::size_t>(options_.batch, rows.size() - first_);
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first_);
    MotionBatch batch;
    batch.rows.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    batch.frames = frames;
    values_.clear();
    for (const auto row : batch.rows) append(info_.names[row], frames);
    batch.values = values_;
    first_ += count;
    if (first_ == rows.size()) {
        first_ = 0;
        ++at_;
    }
    return batch;
}

}  // namespace

std::unique_ptr<MotionSource> open_motions(const fs::path& file, MotionsFileOptions options) {
    return std::make_unique<MotionsFileSource>(file, std::move(options));
}

MotionSet motions_in(const fs::path& file, const MotionsFileOptions& options) {
    if (fs::exists(file) && !fs::is_regular_file(file))
        throw Error("{}: is no file; a file of motions (.h5) is expected", file.string());
    if (!fs::is_regular_file(file))
        throw Error("{}: no such file of motions{}", file.string(), did_you_mean(file));
    auto key = checksum_file(file);
    if (options.frames > 0) key += fmt::format("|{} frames", options.frames);
    if (!options.labels.empty()) {
        Checksum labels;
        for (const auto& [name, label] : options.labels) labels.add(fmt::format("|{}|{}", name, label));
        key += "|labels " + labels.hex();
    }
    return {file.string(), key, {}, [file, options] { return open_motions(file, options); }};
}

}  // namespace actformer::eval
