// NTU-13: 13 actions of NTU RGB+D as VIBE saw them (Guo et al. 2020, Petrovich et al. 2021), a joblib file a video and a list of
// the videos, ntu_vibe_list.txt.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

struct Ntu13Options {
    std::string dataset;  ///< the dataset's name
    bool joints = false;  ///< Action2Motion's 18 joints out of VIBE's, and not SMPL's rotations
    RotationalTarget
        target;  ///< of rotations; joints become limbs, or positions where its representation is xyz
    bool published = false;  ///< the camera's frame with y down, as the public tools leave it
};

/// One dataset without splits, as published. Person 1 of every file that the list names, or of all files where there is no list.
class Ntu13Format : public Format {
  public:
    explicit Ntu13Format(Ntu13Options options);

    std::vector<std::string_view> extensions() const override { return {".pkl", ".txt"}; }
    std::uint64_t largest_file() const override {
        return std::uint64_t{4} << 30;
    }  // with thousands of vertices a frame
    Survey surveys() const override { return Survey::texts; }
    bool surveys_text_of(const RawText& raw) const override { return is_list(raw); }
    void survey(const RawText& raw) override;
    void settle() override;
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override;
    std::vector<std::string> remarks() const override { return remarks_; }
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    static bool is_list(const RawText& raw);
    ParsedClip parse(const RawText& raw) const;

    Ntu13Options options_;
    std::vector<DatasetHeader> datasets_;
    std::mutex surveying_;
    std::map<std::string, std::string> listed_;  ///< name of a clip -> its line in the list
    std::vector<std::string> seen_;              ///< names of the files
    std::vector<std::string> absent_;            ///< lines of the list
    std::vector<std::string> remarks_;
};

}  // namespace actformer::ingest
