// GTA Combat: files in the public layout (gta_combat_2p.h5 ..), and JTA's annotations. A dataset for every number of persons.
//
// The public files hold unit limbs and the roots' positions, z up, whose x and y are divided by 5. Here they are metres again, y up.
#pragma once

#include "ingest/formats/format.hpp"
#include "ingest/formats/gta/gta_skeleton.hpp"

namespace actformer::hdf5 {
class Reader;
}

namespace actformer::ingest {

struct GtaOptions {
    double root_scale = 5;  ///< what the roots' x and y in the public layout are multiplied by
    std::string
        lengths;  ///< gta_adjacency.h5, whose `avglength` are the limbs' lengths; empty: those of gta_bone_lengths()
    unsigned persons = 0;  ///< of JTA's: those seen in most frames; 0: all
};

class GtaFormat : public Format {
  public:
    /// Throws Error where an option makes no sense, or the file of lengths is none.
    explicit GtaFormat(GtaOptions options);

    std::vector<std::string_view> extensions() const override { return {".h5", ".hdf5", ".json"}; }
    std::uint64_t largest_file() const override { return std::uint64_t{2} << 30; }
    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override;
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

    static constexpr std::uint32_t most_persons = 16;

  private:
    ParsedClip public_clip(const hdf5::Reader& file, const std::string& name) const;
    ParsedClip jta_clip(const RawText& raw) const;

    GtaOptions options_;
    std::vector<float> lengths_;  ///< (22) metres
    std::vector<DatasetHeader> datasets_;
};

}  // namespace actformer::ingest
