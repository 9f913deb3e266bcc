// BVH files of one skeleton as one dataset for the ingest pipeline.
#pragma once

#include <mutex>
#include <optional>
#include <set>

#include "ingest/formats/bvh/bvh_file.hpp"
#include "ingest/formats/bvh/skeleton.hpp"
#include "ingest/formats/format.hpp"
#include "ingest/formats/name_pattern.hpp"

namespace actformer::ingest {

struct BvhOptions {
    std::string dataset;          ///< the dataset's name
    std::string pattern;          ///< of file names, as NamePattern takes it
    float scale = 0.01F;          ///< metres a unit of the files; most are in centimetres
    double fps = 0;               ///< frames a second to resample to; 0: as recorded
    float smooth = 0;             ///< sigma of a Gaussian over frames; 0: none
    bool end_sites = false;       ///< keep end sites as joints
    bool centre_windows = false;  ///< see DatasetHeader
    std::string root;             ///< joint to take as root; empty: automatic_root of the first sound file
    std::vector<std::string> classes;  ///< actions in the order of their labels; empty: all, sorted
    std::vector<Split> splits;         ///< over the pattern's fields
};

/// One person a clip. All files must have the joints of the first sound one that fits the pattern, in its order; offsets and
/// channels may differ.
class BvhFormat : public Format {
  public:
    /// Throws Error where an option makes no sense.
    explicit BvhFormat(BvhOptions options);

    std::vector<std::string_view> extensions() const override { return {".bvh"}; }

    Survey surveys() const override { return Survey::texts; }
    void survey(const RawText& raw) override;

    /// Takes the topology from the first sound file and the classes from the names. Throws Error where no name fits the pattern,
    /// no file is sound, none of the classes is among the actions, or there is no such root.
    void settle() override;

    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override;
    void read(const RawText& raw, ClipSink& sink) const override { sink.take(parse(raw)); }
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

    ParsedClip parse(const RawText& raw) const;

  private:
    /// What the survey has found so far.
    struct Found {
        std::set<std::string> actions;  ///< in the names, each once
        std::string first_name;         ///< of the first file, fitting or not
        std::uint64_t first_index = 0;
        std::optional<BvhFile> example;  ///< the first sound file
        std::uint64_t example_index = 0;
        std::string fault;  ///< of the first file that fits and is not sound
        std::uint64_t fault_index = 0;
    };

    BvhOptions options_;
    NamePattern pattern_;
    std::mutex surveying_;
    Found found_;
    double source_fps_ = 0;  ///< of the example
    std::vector<DatasetHeader> datasets_;
};

}  // namespace actformer::ingest
