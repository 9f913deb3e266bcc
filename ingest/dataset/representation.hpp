// How a motion is written in numbers. The representation travels in dataset.json, in the weights of recognisers and generators, and
// in files of motions.
//
// To add one:
//   1. Give it a place in Representation::Kind and a row in `table` (representation.cpp): name, numbers a node, finish.
//   2. Say in representation.cpp how its nodes hang together, which of them carries the body's position, and which of them move when
//      the body does.
//   3. Say in joint_positions (body_model.cpp) how joints come out of it.
//   4. Where no Finish suits it, add one: normalised (model/generators/finish.cpp) in libtorch, and
//      pose_forward, pose_backward (model/cpu/pose_kernel.cpp) on processors.
//   5. Give tests/support/made_dataset.hpp a small dataset in it. The tests that go through all representations do the rest:
//      they train, generate, score and draw.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dataset/topology.hpp"

namespace actformer::ingest {

/// What is done to the numbers of a network's last linear layer, node by node; the free node stays as it is.
enum class Finish {
    unit,  ///< tanh, then divided by (length + 1e-4): a direction
    orthonormal,  ///< tanh, then Gram and Schmidt: two rows of a rotation; the free node's numbers behind its third are 0
    linear  ///< nothing
};

class Representation {
  public:
    enum Kind {
        limb,   ///< (3): the root's position in metres, and unit vectors from parent to child
        rot6d,  ///< (6): every joint's rotation below its parent, the first two rows of its matrix, r00 r01 r02 r10 r11 r12; one
                ///< more node for the translation in metres, x y z 0 0 0
        xyz     ///< (3): positions of the joints in metres
    };

    constexpr Representation(Kind kind = limb) : kind_(kind) {}
    constexpr operator Kind() const { return kind_; }

    static const std::vector<Representation>& all();

    /// Throws Error, beginning with `where`, for a name that is none of those of all().
    static Representation named(const std::string& name, const std::string& where);

    std::string name() const;
    std::uint32_t numbers() const;  ///< of a node
    Finish finish() const;

    /// Parents of the nodes, -1 for the root: the joints, and where there is one the node of translation, which hangs on the root.
    std::vector<int> node_parents(const Topology& topology) const;
    std::uint32_t nodes(const Topology& topology) const;

    /// The node of `nodes` that carries a position in its first three numbers and is not normalised; none where every node does.
    std::optional<std::uint32_t> free_node(std::uint32_t nodes) const;

    /// The nodes of `nodes` to move when the body moves as a whole: `count` from `first` on, by what the node `root` says.
    struct Moving {
        std::uint32_t root = 0, first = 0, count = 1;
    };
    Moving moving(std::uint32_t nodes) const;

  private:
    Kind kind_;
};

}  // namespace actformer::ingest
