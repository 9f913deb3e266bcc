// The first pass over all BVH and AMC files: what each looks like, and what skeleton, root, rate and scale the dataset gets.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/topology.hpp"
#include "ingest/formats/bvh/bvh_options.hpp"
#include "ingest/formats/skeletal/recording.hpp"
#include "ingest/formats/skeletal/stance.hpp"

namespace actformer::ingest {

/// One sound file whose action is wanted.
struct SurveyedFile {
    std::uint64_t index = 0;  ///< in the source's order
    std::string name, path;
    std::string group;  ///< the same for the files of one clip, a person each; empty where the file is a clip
    double fps = 0;
    std::uint32_t frames = 0;
    std::size_t persons = 0;

    // Of the first person.
    std::size_t tree = 0;  ///< index into BvhSurvey's
    std::size_t root = 0;  ///< joint that carries the body through space, in this file
    std::string root_name;
    Stance stance;
};

/// What the dataset is, as far as the files decide it.
struct BvhDecision {
    Topology topology;
    double fps = 0;
    std::size_t persons = 1;
    float scale = 0;
    std::vector<std::string> remarks;  ///< what the user should know, a line each
};

class BvhSurvey {
  public:
    /// Looks at a file. Any number of threads at once.
    static SurveyedFile look_at(std::vector<Recording>& persons, const BvhOptions& options,
                                const BvhSettings& settings);

    /// Notes a file looked at, of which `first` is the first person. One thread at a time.
    void add(SurveyedFile file, const Recording& first, bool end_sites);

    const std::vector<SurveyedFile>& files() const { return files_; }

    /// After the last add(). The commonest skeleton wins, and among its files the commonest rate and number of persons. Throws Error
    /// where there is no file, or no such root.
    BvhDecision decide(const BvhOptions& options, const BvhSettings& settings);

  private:
    /// Files of the same joints that hang together in the same way, in whatever order.
    struct Tree {
        std::uint64_t first = 0;  ///< index of the first file of these
        Recording example;        ///< that file's joints, without frames
        std::size_t files = 0;
    };

    std::size_t commonest_tree() const;
    std::size_t root_of(const Tree& tree, const std::vector<const SurveyedFile*>& members,
                        const std::string& wanted) const;

    std::map<std::string, std::size_t> by_key_;
    std::vector<Tree> trees_;
    std::vector<SurveyedFile> files_;
};

}  // namespace actformer::ingest
