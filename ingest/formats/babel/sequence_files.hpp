// Which file of AMASS holds the motion of a sequence of BABEL.
//
// BABEL names a motion FOLDER/SET/SUBJECT/TRIAL_poses.npz, by the names that AMASS's subsets had then: BMLrub/BioMotionLab_NTroje,
// DFaust67/DFaust_67. Archives of other years unpack as SET or FOLDER or under a newer name, and the package SMPL-X calls its files
// TRIAL_stageii.npz.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace actformer::ingest {

class SequenceFiles {
  public:
    /// Sequences are counted from 0 in the order they are added. False where `feat_p` does not have the form.
    bool add(std::string_view feat_p);

    /// The sequences whose motion is in the file at `path`, or ARCHIVE:MEMBER. Capitals do not count, blanks and _ are alike, and a
    /// path without the name of a subset may be of any.
    std::vector<std::size_t> of(std::string_view path) const;

    /// The subset that a folder or archive of `path` names, its last one, whatever its name there; empty where none does.
    std::string subset_of(std::string_view path) const;

  private:
    struct Entry {
        std::size_t sequence;
        std::string folder, set;  ///< as canonical() has them
    };
    std::unordered_map<std::string, std::vector<Entry>> by_trial_;  ///< subject/trial
    std::unordered_set<std::string> sets_;  ///< folders and sets of all sequences, as canonical() has them
    std::size_t count_ = 0;
};

}  // namespace actformer::ingest
