// Motions in the public ActFormer layout: an HDF5 file with one float32 dataset (P*C, K, T) a clip: of P persons, each with K
// nodes of C numbers, as the motions' representation has them.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files/aside.hpp"
#include "ingest/dataset/motion.hpp"
#include "ingest/dataset/subjects.hpp"

namespace actformer::ingest {

/// A clip's name as the public tools expect it: where it ends in A and three digits, as NTU's do, these become label + 1.
std::string public_name(const std::string& name, std::uint32_t label);

/// What a file may say of one motion.
struct MotionDetails {
    std::optional<std::uint32_t> label;  ///< from 0
    std::vector<float> bone_length;      ///< (persons, joints) metres; empty: as of all motions in the file
};

/// The attribute `label` of the array `name`. Throws Error, beginning with `where`, for a label that is none.
std::optional<std::uint32_t> read_label(const hdf5::Reader& file, const std::string& name,
                                        const std::string& where);

/// That and `bone_length`.
MotionDetails read_details(const hdf5::Reader& file, const std::string& name, const std::string& where);

/// Reads motions one at a time. Throws Error for a file that is not in the public layout.
class MotionsFile {
  public:
    /// `otherwise` is the representation of a file that does not tell its own.
    explicit MotionsFile(const std::filesystem::path& path, Representation otherwise = Representation::limb);
    MotionsFile(MotionsFile&& other) noexcept;
    ~MotionsFile();

    const std::vector<std::string>& names() const { return names_; }  ///< sorted
    Motion read(const std::string& name) const;

    /// As read_details.
    MotionDetails details(const std::string& name) const;

    Representation representation() const { return representation_; }

    /// Throws Error, with the remedy, where the file does not tell its representation, is taken for one of limbs, and its first
    /// motion has none.
    void check_limbs() const;

    /// Whose motions they are, where the file tells.
    const std::optional<Subjects>& subjects() const { return subjects_; }

  private:
    struct Handle;
    std::filesystem::path path_;
    std::unique_ptr<Handle> file_;
    Representation representation_;
    bool tells_representation_ = false;
    std::vector<std::string> names_;
    std::optional<Subjects> subjects_;
};

/// Writes motions one at a time; the file appears at `path` at finish(), and not at all without it.
class MotionsWriter {
  public:
    explicit MotionsWriter(const std::filesystem::path& path, Sync sync = Sync::now);
    ~MotionsWriter();
    void add(const std::string& name, const Motion& motion, const MotionDetails& details = {});

    /// Attributes of the file: whose motions they are, and a line of where they come from.
    void describe(const Subjects& subjects);
    void note(const std::string& attribute, const std::string& text);

    void finish();

  private:
    struct Handle;
    std::unique_ptr<Handle> file_;
};

}  // namespace actformer::ingest
