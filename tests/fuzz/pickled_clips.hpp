// What the fuzzers of pickled formats share.
#pragma once

#include <initializer_list>
#include <memory>
#include <string_view>
#include <variant>

#include "ingest/formats/format.hpp"
#include "ingest/formats/motions/position_clips.hpp"
#include "ingest/formats/rotational/rotational_clip.hpp"
#include "tests/fuzz/fuzzing.hpp"

namespace actformer::fuzzing {

/// Clips hold as many numbers as they say, and rejections are one line.
class CheckedClips : public ingest::ClipSink {
  public:
    explicit CheckedClips(const ingest::DatasetHeader& header) : header_(header) {}

    void take(ingest::ParsedClip clip) override {
        if (const auto* rejection = std::get_if<ingest::Rejection>(&clip)) {
            demand_one_line(rejection->reason);
            return;
        }
        const auto& made = *std::get<0>(clip);
        demand(made.label < header_.classes.size() && made.fields.size() == header_.fields.size());
        if (const auto* rotations = dynamic_cast<const ingest::RotationalClip*>(&made))
            demand(rotations->frames > 0 &&
                   rotations->values.size() == rotations->frames * header_.frame_values());
        if (const auto* positions = dynamic_cast<const ingest::PositionClip*>(&made))
            demand(positions->frames > 0 &&
                   positions->values.size() == positions->frames * header_.frame_values());
    }

  private:
    const ingest::DatasetHeader& header_;
};

inline ingest::RawText file_of(std::string_view path, std::string_view text) {
    return {path, path.substr(0, path.rfind('.')), text, path};
}

/// The format as the pipeline has it from its first file to its last: it has seen all files, and is settled.
inline std::unique_ptr<const ingest::Format> ready(std::unique_ptr<ingest::Format> format,
                                                   std::initializer_list<ingest::RawText> files) {
    for (const auto& file : files) format->survey(file);
    format->settle();
    return format;
}

/// Any bytes as the pickle of that name.
inline void read_pickle(const ingest::Format& format, std::string_view path, std::string_view text) {
    CheckedClips sink(format.datasets()[0]);
    format.read(file_of(path, text), sink);
}

}  // namespace actformer::fuzzing
