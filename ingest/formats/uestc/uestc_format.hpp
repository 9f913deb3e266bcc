// UESTC (Ji et al. 2018) as VIBE saw it (Petrovich et al. 2021): all videos in vibe_cache_refined.pkl, and beside it in info/ their
// names (names.txt), how many of their frames count (num_frames_min.txt) and the actions (action_classes.txt).
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

class UestcFormat : public Format {
  public:
    /// `published`: the camera's frame with y down, as the public tools leave it; bodies stand upright else.
    UestcFormat(const std::string& dataset, RotationalTarget target, bool published = false)
        : name_(dataset), target_(std::move(target)), published_(published) {}

    std::vector<std::string_view> extensions() const override { return {".pkl", ".txt"}; }
    std::uint64_t largest_file() const override { return std::uint64_t{1} << 40; }
    Survey surveys() const override { return Survey::texts; }
    bool surveys_text_of(const RawText& raw) const override { return raw.ends_in(".txt"); }
    void survey(const RawText& raw) override;

    /// Throws Error where one of the lists is not there, or there twice with other contents, or they do not fit together.
    void settle() override;

    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override {
        return (published_ ? "uestc, y down: " : "uestc: ") + target_.text();
    }
    std::vector<std::string> remarks() const override { return remarks_; }
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device&, std::size_t,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override {
        return gathered(clips, target_, frames);
    }

  private:
    class Videos;

    /// A .txt file.
    struct List {
        std::string path;
        std::vector<std::string> lines;
    };
    const std::vector<std::string>& list(const std::string& name) const;
    ParsedClip parse(const Videos& videos, std::size_t video) const;

    std::string name_;
    RotationalTarget target_;
    bool published_;
    std::mutex surveying_;
    std::map<std::string, std::map<std::uint64_t, List>> lists_;  ///< by name, and by the file's index
    std::vector<std::string> names_;                              ///< of the videos, in the pickle's order
    std::vector<std::uint64_t> frames_;                           ///< of each that count
    std::vector<DatasetHeader> datasets_;
    std::vector<std::string> remarks_;
};

}  // namespace actformer::ingest
