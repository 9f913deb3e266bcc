// AMASS's recordings cut into clips by BABEL's labels: one dataset for the ingest pipeline.
//
// A clip is what one label shows of one category: a label of two categories gives two clips of the same motion. Labels are those of
// frame_ann, or of seq_ann, over the whole recording, where there is none.
#pragma once

#include <map>
#include <mutex>
#include <unordered_map>

#include "ingest/formats/babel/amass_file.hpp"
#include "ingest/formats/babel/annotations.hpp"
#include "ingest/formats/babel/sequence_files.hpp"
#include "ingest/formats/format.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"

namespace actformer::ingest {

struct BabelOptions {
    std::string dataset;             ///< the dataset's name
    std::string categories = "120";  ///< as categories_called takes them
    double fps = 30;                 ///< frames a second of the dataset
    bool published = false;          ///< resample as the public tools do (zoom.hpp), and leave z up
    RotationalOptions rotational;
};

class BabelFormat : public Format {
  public:
    /// Throws Error where an option makes no sense.
    explicit BabelFormat(BabelOptions options);

    std::vector<std::string_view> extensions() const override { return {".npz", ".json"}; }
    std::uint64_t largest_file() const override { return std::uint64_t{1} << 30; }
    Survey surveys() const override { return Survey::texts; }
    bool surveys_text_of(const RawText& raw) const override;
    void survey(const RawText& raw) override;

    /// Throws Error where no file holds annotations, or no file the motion of a sequence.
    void settle() override;

    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    std::string settings() const override;
    std::vector<std::string> remarks() const override { return remarks_; }
    std::optional<Rejection> refuse(const RawText& raw) const override;
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    struct AnnotationFile {
        std::string path, split;
        std::variant<Annotations, Rejection> said;
        std::size_t first = 0;  ///< of its sequences in sequences_

        /// Of sequences that are taken; null where the file is none of theirs.
        const Annotations* annotations() const;
    };
    struct Labelled {
        Sequence sequence;
        std::string split;
        bool found = false;  ///< there is a file
    };

    void gather_sequences();
    void find_files();
    void remark();
    void read_annotation_file(const AnnotationFile& file, ClipSink& sink) const;
    void cut_all(const RawText& raw, const AmassRecording& recording, ClipSink& sink) const;
    void cut(const Labelled& labelled, const RotationalTrack& track, const std::vector<std::string>& doubts,
             ClipSink& sink) const;

    BabelOptions options_;
    RotationalTarget target_;
    std::unordered_map<std::string, std::uint32_t> labels_;  ///< by category
    std::mutex surveying_;
    std::map<std::uint64_t, AnnotationFile> annotations_;  ///< by index
    std::map<std::uint64_t, std::string> files_;           ///< of motion: path by index
    bool settled_ = false;
    std::vector<Labelled> sequences_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> of_file_;  ///< sequences by a file's index
    std::vector<std::string> remarks_;
    std::vector<DatasetHeader> datasets_;
};

}  // namespace actformer::ingest
