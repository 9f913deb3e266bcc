// Methods of generating motions. Trainer, scoring, `generate`, `model`, sweep and report know them through this header alone.
//
// To add a method called NAME:
//   1. a folder model/generators/NAME/, whose names begin with the method's or live in a namespace of it, with its networks
//      (model/nn has weights with spectral norms, fused layers and optimisers), a Learner (model/train/learner.hpp) and a Maker (below);
//   2. NAME/method.hpp, which declares `Method NAME_method();`, and NAME/method.cpp, which fills in the members of Method;
//   3. one #include and one line in methods.cpp;
//   4. a configuration in model/configs with the line `model: NAME`;
//   5. tests in tests/model/generators/NAME/. tests/model/generators/methods_test.cpp trains and generates with every method
//      of the list as it is.
// docs/adding-a-method.md walks through it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/subjects.hpp"
#include "model/nn/array.hpp"
#include "model/nn/network.hpp"
#include "model/train/config.hpp"

namespace actformer::model {

class Learner;
struct LearnerSetup;

/// What motions are generated: networks are made to fit.
struct MotionSpec {
    ingest::Representation representation;
    ingest::Topology topology;
    std::uint32_t persons = 1, classes = 0;
    std::string where;  ///< dataset or file that it comes from, for error messages
    std::vector<float> bone_length = {}, rest = {};  ///< as ingest::BodyModel has them

    std::uint32_t nodes() const { return representation.nodes(topology); }  ///< K
    std::uint32_t numbers() const { return representation.numbers(); }      ///< of a node, D
};

MotionSpec spec_of(const ingest::Subjects& subjects, const std::string& where);

/// Makes motions out of trained weights.
class Maker {
  public:
    virtual ~Maker() = default;

    /// Frames that a motion may have at most.
    virtual std::uint32_t most_frames() const = 0;

    /// Motions of a batch. A batch goes through the network whole, wanted or not, and every motion in the same place: what
    /// is wanted beside a motion changes no bit of it.
    virtual std::uint32_t batch() const = 0;

    /// Motions index * batch() and on of class `label`, from 0: (batch(), P*D, T, K) row-major. A motion is a function of the
    /// seed, its class and its number alone.
    virtual std::vector<float> make(std::uint64_t seed, std::uint32_t label, std::uint32_t index,
                                    std::uint32_t frames) = 0;
};

/// A released checkpoint as a method takes it.
struct PublicWeights {
    std::vector<std::string> settings;  ///< of its configuration, key=value
    std::vector<Array> weights;         ///< under the names of its own
};

/// Throws Error, beginning with spec.where, unless weights for `numbers` numbers a frame fit the motions.
void check_frame(std::int64_t numbers, const MotionSpec& spec);

struct Method {
    std::string name;   ///< as in a configuration's line `model: NAME`
    std::string title;  ///< for the help text, with its source

    /// Keys of its networks and of its training, those of generator_keys() apart. `persons`, `classes` (0: as the dataset
    /// has them) and `frames` must be among them.
    std::vector<Key> (*keys)() = nullptr;

    /// Its networks' layers, for `actformer model`.
    std::vector<NetworkSummary> (*networks)(const Config& config, const MotionSpec& spec) = nullptr;

    /// What trains it. Throws Error for a configuration of no network.
    std::unique_ptr<Learner> (*learner)(const Config& config, const MotionSpec& spec,
                                        const LearnerSetup& setup) = nullptr;

    /// `weights` as a learner gives them, on libtorch's device `device`. Throws Error, beginning with spec.where, for weights
    /// that are missing or of another shape, before it takes the memory that the configuration asks for (check_weights_fit).
    std::unique_ptr<Maker> (*maker)(const Config& config, const MotionSpec& spec,
                                    const std::vector<Array>& weights, const std::string& device) = nullptr;

    /// Null where nobody released weights. `arrays` are a checkpoint's, named as in its state_dict: none where they are another
    /// method's. Throws Error, beginning with spec.where, where they are for other motions or of a variant.
    std::optional<PublicWeights> (*public_weights)(std::vector<Array> arrays,
                                                   const MotionSpec& spec) = nullptr;
};

/// All methods; the first is what a configuration without the line `model:` means.
const std::vector<Method>& methods();

/// Throws Error, beginning with `where`, for a name that is none's.
const Method& method_named(const std::string& name, const std::string& where);

/// Every key of a method's configuration at its preset.
Config generator_config(const Method& method);

/// A configuration file for the method that it names.
Config read_generator_config(const std::filesystem::path& file);

}  // namespace actformer::model
