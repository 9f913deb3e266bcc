#include "ingest/export/clip_source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "ingest/dataset/described_motions.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

class DatasetClips : public ClipSource {
  public:
    explicit DatasetClips(const fs::path& folder) : ClipSource(folder), dataset_(folder) {
        for (const auto& clip : dataset_.clips()) clips_.push_back({clip.name, clip.label});
        if (!clips_.empty()) subjects_ = subjects_of(dataset_);
        name_publicly();
    }

    std::string fingerprint() const override { return dataset_.fingerprint(); }
    std::vector<std::size_t> split(const std::string& name) const override { return dataset_.split(name); }

  protected:
    ExportClip read_unchecked(std::size_t clip) const override {
        return {clips_[clip], public_names_[clip], dataset_.motion(clip), dataset_.body(clip)};
    }

  private:
    /// Where two clips would be called alike, a number before the class tells them apart. Names that stay as they are come first.
    void name_publicly() {
        std::set<std::string> taken;
        for (const auto& clip : clips_) {
            public_names_.push_back(public_name(clip.name, *clip.label));
            if (public_names_.back() == clip.name) taken.insert(clip.name);
        }
        constexpr std::size_t class_length = 4;  // A and three digits
        for (std::size_t i = 0; i < clips_.size(); ++i) {
            auto& name = public_names_[i];
            if (name == clips_[i].name || taken.insert(name).second) continue;
            const auto stem = name.substr(0, name.size() - class_length), of_class = name.substr(stem.size());
            for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}_{}{}", stem, n, of_class);
            if (public_names_note_.empty())
                public_names_note_ = fmt::format(
                    "some clips would be called alike with their class at the end, and have numbers before "
                    "it, as {} for {}",
                    in_quotes(name), in_quotes(clips_[i].name));
        }
    }

    Dataset dataset_;
    std::vector<std::string> public_names_;  ///< (clips)
};

class MotionsClips : public ClipSource {
  public:
    MotionsClips(const fs::path& path, const fs::path& bones) : ClipSource(path), file_(path, bones) {
        subjects_ = file_.subjects();
        for (const auto& name : file_.motions().names()) clips_.push_back({name, file_.label(name)});
    }

    std::string fingerprint() const override { return checksum_file(path()); }

    std::vector<std::size_t> split(const std::string& name) const override {
        if (name != "all")
            throw Error("{}: a motions file has no splits; leave --split out", path().string());
        std::vector<std::size_t> every(clips_.size());
        for (std::size_t i = 0; i < every.size(); ++i) every[i] = i;
        return every;
    }

  protected:
    ExportClip read_unchecked(std::size_t clip) const override {
        const auto& name = clips_[clip].name;
        return {clips_[clip], name, file_.motions().read(name), file_.body(name)};
    }

  private:
    DescribedMotions file_;
};

void check_finite(const Motion& motion, const std::string& where) {
    if (motion.frames == 0) throw Error("{}: clip {} has no frames; leave it out", where, motion.name);
    for (std::size_t i = 0; i < motion.values.size(); ++i) {
        if (std::isfinite(motion.values[i])) continue;
        const auto node = i / motion.numbers % motion.nodes,
                   person = i / motion.numbers / motion.nodes % motion.persons;
        throw Error(
            "{}: clip {} holds a number that is not finite (frame {}, person {}, node {}); leave it out, or "
            "make it anew",
            where, motion.name, i / motion.numbers / motion.nodes / motion.persons + 1, person + 1, node + 1);
    }
}

}  // namespace

ExportClip ClipSource::read(std::size_t clip) const {
    auto read = read_unchecked(clip);
    check_finite(read.motion, path_.string());
    check_fits(read.motion, read.body);
    return read;
}

std::unique_ptr<ClipSource> open_clips(const fs::path& path, const fs::path& bones) {
    std::error_code ignored;
    if (!fs::exists(path, ignored))
        throw Error("{}: no such file or folder{}", path.string(), did_you_mean(path));
    if (!fs::is_directory(path, ignored)) return std::make_unique<MotionsClips>(path, bones);
    if (!bones.empty()) throw Error("{}: a dataset has bones of its own; leave --bones out", path.string());
    const auto folders = datasets_at(path);
    if (folders.size() != 1)
        throw Error("{}: holds {} datasets; export one at a time, as in {}", path.string(), folders.size(),
                    folders[0].string());
    return std::make_unique<DatasetClips>(folders[0]);
}

}  // namespace actformer::ingest
