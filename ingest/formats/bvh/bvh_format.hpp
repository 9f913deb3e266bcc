// BVH files of one skeleton as one dataset for the ingest pipeline.
#pragma once

#include <filesystem>

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

/// One person a clip. All files must have the joints of `example`, in its order; offsets and channels may
/// differ.
class BvhFormat : public Format {
  public:
    /// `actions` are those in the files' names, sorted; the topology comes from `example`.
    /// Throws Error where an option makes no sense, none of the classes is among the actions, or there is no
    /// such root.
    BvhFormat(BvhOptions options, const std::vector<std::string>& actions, const BvhFile& example);

    std::string_view extension() const override { return ".bvh"; }
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override;
    ParsedClip parse(const RawText& raw) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    BvhOptions options_;
    NamePattern pattern_;
    double source_fps_;  ///< of the example
    std::vector<DatasetHeader> datasets_;
};

/// The values of {action} in file names without extension, sorted, each once. Throws Error where no name fits
/// the pattern.
std::vector<std::string> actions_in(const std::vector<std::string>& stems, const NamePattern& pattern);

/// The format for the files at `raw`: lists their names and takes the topology from the first sound one that
/// fits the pattern. Throws Error as BvhFormat and actions_in do, and where no file is sound.
std::unique_ptr<BvhFormat> open_bvh(const BvhOptions& options, const std::vector<std::filesystem::path>& raw);

}  // namespace actformer::ingest
