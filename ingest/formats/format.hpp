// What the ingest pipeline asks of a raw format (NTU, BVH, ...): which files are its own, what clips they hold, and how clips become
// motions. A format includes nothing of the pipeline.
//
// To add a format called NAME:
//   1. Make a folder formats/NAME/ with a reader of its files: bytes in, plain values or a Rejection out.
//   2. In NAME/NAME_format.{hpp,cpp}, derive a clip from RawClip and the format from Format: read() hands the clips of a file to a sink.
//   3. Beside it, derive NameCommand from IngestCommand: the options of `actformer ingest NAME`, and how they open the format.
//   4. Add its line to formats.cpp. The command, its help and its options come from there.
//   5. Test the reader and the format in tests/ingest/formats/NAME/; fuzz the reader with tests/fuzz/NAME_fuzz.cpp and a seed or two.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/files/mapped_file.hpp"
#include "base/text/extension.hpp"
#include "ingest/dataset/dataset.hpp"
#include "ingest/formats/text_checksum.hpp"
#include "kernels/cleaning.hpp"

namespace actformer::ingest {

/// One raw file. In memory, 64 readable zero bytes follow `text`, so that readers may load past its end.
struct RawText {
    std::string_view path;      ///< for messages: the file, or archive:member
    std::string_view stem;      ///< file name without folder and extension
    std::string_view text;      ///< empty where only the name is asked about
    std::string_view inside{};  ///< path below the folder or archive that was given, as in "walk/001.bvh"
    std::uint64_t index = 0;    ///< of the file in the source's order, which depends on names alone
    bool on_disk = false;       ///< `path` is a file that a library can open
    const MappedFile* mapped = nullptr;  ///< what the text of a large file lies in
    TextChecksum* checksum = nullptr;    ///< takes in what is released

    /// Whether the path ends in `extension`, as in ".pkl", in any case.
    bool ends_in(std::string_view extension) const { return ends_in_extension(path, extension); }

    /// The text before `here` has been read for good: memory stays flat over a large file.
    void release(const char* here) const {
        if (checksum) checksum->take_until(here);
        if (mapped) mapped->release(here);
    }

    /// `bytes` more of the text, wherever they lie, have been read for good: memory stays flat where a large file is read here and there.
    void release_read(std::size_t bytes) const {
        if (mapped) mapped->release_read(bytes);
    }
};

/// A parsed clip, before it is cleaned. Formats derive from it what they need to know.
struct RawClip {
    virtual ~RawClip() = default;
    std::size_t dataset = 0;  ///< index into Format::datasets()
    std::string name;         ///< unique over all files
    std::uint32_t label = 0;
    std::vector<std::string> fields;  ///< as the dataset's header names them

    /// What is doubtful about the clip, in words that other clips share: the summary counts the clips of each doubt.
    /// As in "the tracking number changes: --join-tracks makes one body of such tracks".
    std::vector<std::string> doubts;

    /// About how much memory the clip takes.
    virtual std::size_t bytes() const = 0;
};

/// A clip that cannot be used, and why. Where a file holds more than this clip the reason begins with the place:
/// "line 12: 26 joints, not 25", "clip 17: no number in it".
struct Rejection {
    enum class Kind {
        broken,   ///< the file is at fault; --strict stops at it
        dropped,  ///< a sound clip that no dataset is for: too few persons, or a class that is not asked for
        missing,  ///< named in the missing list
        duplicate
    };
    Kind kind = Kind::broken;
    std::string reason;
};

using ParsedClip = std::variant<std::unique_ptr<RawClip>, Rejection>;

/// Takes what a file holds, in its order.
class ClipSink {
  public:
    virtual ~ClipSink() = default;

    /// May wait until earlier clips have been cleaned, so that a file of many clips need not fit in memory.
    virtual void take(ParsedClip clip) = 0;

    /// How many threads may make the file's clips: other files have the others.
    virtual unsigned threads() const { return 1; }
};

class Format {
  public:
    virtual ~Format() = default;

    /// As in ".skeleton"; compared in any case.
    virtual std::vector<std::string_view> extensions() const = 0;

    /// Bytes beyond which a file is none of the format's, but an accident. Larger ones are rejected unread.
    virtual std::uint64_t largest_file() const { return std::uint64_t{128} << 20; }

    /// What the format must know of all files before the first is read.
    enum class Survey { nothing, names, texts };
    virtual Survey surveys() const { return Survey::nothing; }

    /// Called once a file, from many threads at once and in any order; without its text where names are all that is asked for.
    /// Throws nothing for what is in the text. Files that cannot be read are passed over.
    virtual void survey(const RawText&) {}

    /// Whether a survey of texts needs this file's text. Other files come by their names alone: those out of archives are then not
    /// unpacked for it. Called from many threads at once.
    virtual bool surveys_text_of(const RawText&) const { return true; }

    /// After the last survey(), and always before what follows. Throws Error where the files make no dataset.
    virtual void settle() {}

    /// The datasets that clips go to.
    virtual const std::vector<DatasetHeader>& datasets() const = 0;

    /// True where classes that end up without a clip are to be dropped from the datasets, and the others renumbered.
    virtual bool drops_empty_classes() const { return false; }

    /// Everything that decides the output beside the raw files: options, as text.
    virtual std::string settings() const = 0;

    /// What the user should know of the data as a whole, a line each, as in "the root is 'Hips'".
    virtual std::vector<std::string> remarks() const { return {}; }

    /// A file that need not be read, by its name: RawText::text is empty. Called from many threads at once.
    virtual std::optional<Rejection> refuse(const RawText&) const { return {}; }

    /// Hands the file's clips to `sink`, rejected ones too. Called from many threads at once. Never throws for what is in the text.
    virtual void read(const RawText& raw, ClipSink& sink) const = 0;

    /// Cleans clips of one dataset on the device, in their order; `frames` becomes their lengths.
    virtual kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                        std::span<const std::unique_ptr<RawClip>> clips,
                                        std::vector<std::uint32_t>& frames) const = 0;
};

/// An option of `actformer ingest NAME`, and where its value goes.
struct Option {
    using Value = std::variant<bool*, unsigned*, float*, double*, std::string*, std::vector<std::string>*>;

    std::string flag;  ///< "--fps"
    std::string help;
    std::string placeholder;  ///< of its value in the help, as in "F"; empty for a flag
    Value value;
    bool is_required = false;
    bool shows_default = false;
    bool splits_at_commas = false;     ///< a list is given as A,B,...; else by giving the option again
    std::vector<std::string> choices;  ///< the only values there are; empty: any

    Option(std::string flag_, std::string help_, std::string placeholder_, Value value_)
        : flag(std::move(flag_)),
          help(std::move(help_)),
          placeholder(std::move(placeholder_)),
          value(value_) {}

    Option& required() {
        is_required = true;
        return *this;
    }
    Option& with_default() {
        shows_default = true;
        return *this;
    }
    Option& by_commas() {
        splits_at_commas = true;
        return *this;
    }
    Option& one_of(std::vector<std::string> values) {
        choices = std::move(values);
        return *this;
    }
};

/// `actformer ingest NAME`: its options, and the format they open.
class IngestCommand {
  public:
    virtual ~IngestCommand() = default;

    /// The options, each bound to a member of this object.
    virtual std::vector<Option> list() = 0;

    /// True where OUT itself is the dataset; else the datasets lie in it, OUT/NAME.
    virtual bool one_dataset() const { return true; }

    /// `dataset` is the name for a format's only dataset. Throws Error where an option makes no sense.
    virtual std::unique_ptr<Format> open(const std::string& dataset) const = 0;
};

}  // namespace actformer::ingest
