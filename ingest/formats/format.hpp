// What the ingest pipeline asks of a raw format (NTU, BVH, ...): which files are its own, how one becomes a clip, and how clips
// become motions.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ingest/dataset/dataset.hpp"
#include "kernels/cleaning.hpp"

namespace actformer::ingest {

/// One raw file in memory. At least 64 readable zero bytes follow `text`, so that readers may load past its end.
struct RawText {
    std::string_view path;  ///< for messages: the file, or archive:member
    std::string_view stem;  ///< file name without folder and extension
    std::string_view text;
};

/// A parsed clip, before it is cleaned. Formats derive from it what they need to know.
struct RawClip {
    virtual ~RawClip() = default;
    std::size_t dataset = 0;  ///< index into Format::datasets()
    std::string name;
    std::uint32_t label = 0;
    std::vector<std::string> fields;  ///< as the dataset's header names them
};

/// A clip that cannot be used, and why: "line 12: 26 joints, not 25".
struct Rejection {
    enum class Kind {
        broken,   ///< the file is at fault; --strict stops at it
        dropped,  ///< a sound file that no dataset is for: too few persons, or a class that is not asked for
        missing,  ///< named in the missing list
        duplicate
    };
    Kind kind = Kind::broken;
    std::string reason;
};

using ParsedClip = std::variant<std::unique_ptr<RawClip>, Rejection>;

class Format {
  public:
    virtual ~Format() = default;

    /// As in ".skeleton"; compared in any case.
    virtual std::string_view extension() const = 0;

    /// The datasets that clips go to; their headers are whole before the first clip is parsed.
    virtual const std::vector<DatasetHeader>& datasets() const = 0;

    /// Everything that decides the output beside the raw files: options, as text.
    virtual std::string settings() const = 0;

    /// Called from many threads at once. Never throws for what is in the text: it rejects.
    virtual ParsedClip parse(const RawText& raw) const = 0;

    /// Cleans clips of one dataset on the device, in their order.
    virtual kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                        std::span<const std::unique_ptr<RawClip>> clips,
                                        std::vector<std::uint32_t>& frames) const = 0;
};

}  // namespace actformer::ingest
