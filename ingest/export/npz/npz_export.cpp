#include "ingest/export/npz/npz_export.hpp"

#include <fmt/format.h>

#include <unordered_set>

#include "ingest/export/fit_name.hpp"
#include "ingest/export/npz/npz_writer.hpp"
#include "ingest/export/skeletons.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

class NpzExport : public ExportFile {
  public:
    NpzExport(const fs::path& path, const ExportContext& context)
        : path_(path), context_(context), npz_(path, context.sync) {}

    void add(const ExportClip& clip) override {
        const auto name = free_name(clip.name);
        std::vector<float> values;
        for (const auto& joint : clip_joints(clip))
            for (const double v : joint) values.push_back(static_cast<float>(v));
        npz_.add(name, {clip.motion.frames, clip.motion.persons, context_.subjects.topology.joints(), 3},
                 std::span<const float>(values));
        names_.push_back(name);
        clips_.push_back(clip.name);
        labels_.push_back(clip.label ? std::int64_t{*clip.label} : -1);
    }

    std::vector<fs::path> finish() override {
        const auto& subjects = context_.subjects;
        const std::vector<std::int64_t> parents(subjects.topology.parents.begin(),
                                                subjects.topology.parents.end());
        npz_.add("clips", names_);
        npz_.add("labels", {labels_.size()}, std::span<const std::int64_t>(labels_));
        npz_.add("classes", subjects.classes);
        npz_.add("names", subjects.topology.names);
        npz_.add("parents", {parents.size()}, std::span<const std::int64_t>(parents));
        npz_.add("fps", {}, std::span<const double>(&subjects.fps, 1));
        npz_.add("program", "actformer " ACTFORMER_VERSION);
        npz_.add("source", context_.source);
        npz_.finish();
        return {path_};
    }

    std::string note() const override { return names_changed(clips_, names_, "clip name"); }

  private:
    /// The clip's name, or a like one that no other array has.
    std::string free_name(const std::string& name) {
        const auto fit = fit_name(name, NameFor::file);
        auto one = fit;
        for (int i = 2; !taken_.insert(one).second; ++i) one = fmt::format("{}_{}", fit, i);
        return one;
    }

    fs::path path_;
    const ExportContext& context_;
    NpzWriter npz_;
    std::vector<std::string> clips_, names_;  ///< as they are called, and as their arrays are
    std::vector<std::int64_t> labels_;
    std::unordered_set<std::string> taken_{"clips",   "labels", "classes", "names",
                                           "parents", "fps",    "program", "source"};
};

}  // namespace

std::unique_ptr<ExportFile> open_npz(const fs::path& path, const ExportContext& context) {
    return std::make_unique<NpzExport>(path, context);
}

}  // namespace actformer::ingest
