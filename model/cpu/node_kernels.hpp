// The discriminator's graph convolutions on processors, forward and backward. T float or double.
//
// Motions are (samples, nodes, frames, channels): a node's frames lie end to end, so that the numbers under a temporal
// convolution's taps are one piece of memory and every (hop, input node) is one matrix product, whose results are added to the
// output nodes straight from registers. Frames carry zeros on either side, as many as the next convolution pads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace actformer::model::cpu {

/// The (hop, input node) pairs that feed any output node, and which.
struct NodeSums {
    struct Target {
        std::int64_t output;
        float strength;
    };
    struct Group {
        std::int64_t hop, input;
        std::vector<Target> targets;
    };
    std::vector<Group> groups;                ///< by input node
    std::vector<std::int64_t> first_of_node;  ///< group, for every input node and behind the last

    /// `strengths` (hops, outputs, inputs) row-major: what every output node takes of every input node.
    NodeSums(std::int64_t hops, std::int64_t outputs, std::int64_t inputs, std::span<const float> strengths);
};

/// One layer of graph convolutions and the size of what it is given.
struct NodeShape {
    std::int64_t samples = 0, frames = 0;  ///< frames without the zeros on either side
    std::int64_t in_nodes = 0, out_nodes = 0;
    std::int64_t in = 0, out = 0;                    ///< channels
    std::int64_t taps = 1, stride = 1, padding = 0;  ///< of every temporal convolution
    std::int64_t out_padding = 0;                    ///< zeros on either side of the outputs' frames

    /// Where a group's weights (out, taps * in) are: from one node, hop and row of outputs to the next.
    std::int64_t node_step = 0, hop_step = 0, row_step = 0;

    /// The same layer with weights (in_nodes, hops, out, taps, in): a convolution of its own for every node.
    NodeShape with_weights_by_node(std::int64_t hops) const {
        auto shape = *this;
        shape.row_step = window();
        shape.hop_step = out * window();
        shape.node_step = hops * shape.hop_step;
        return shape;
    }
    /// The same layer with weights (out, hops, taps, in), shared by all nodes.
    NodeShape with_weights_by_hop(std::int64_t hops) const {
        auto shape = *this;
        shape.node_step = 0;
        shape.hop_step = window();
        shape.row_step = hops * window();
        return shape;
    }
    /// The same layer with weights (out, in_nodes, taps, in): one convolution over all nodes, of one hop.
    NodeShape with_weights_by_output() const {
        auto shape = *this;
        shape.node_step = window();
        shape.hop_step = 0;
        shape.row_step = in_nodes * window();
        return shape;
    }

    std::int64_t padded_frames() const { return frames + 2 * padding; }
    std::int64_t out_frames() const { return (padded_frames() - taps) / stride + 1; }
    std::int64_t padded_out_frames() const { return out_frames() + 2 * out_padding; }
    std::int64_t window() const { return taps * in; }
    std::int64_t sample_in() const { return in_nodes * padded_frames() * in; }
    std::int64_t sample_out() const { return out_nodes * padded_out_frames() * out; }
};

/// y (samples, out_nodes, padded_out_frames, out) = leaky(bias + sums of x's convolutions), x (samples, in_nodes,
/// padded_frames, in), bias (out_nodes, out) or null; a negative number is multiplied by `leak`, 1 for
/// a linear layer.
template <typename T>
void node_forward(const NodeShape& shape, const NodeSums& sums, const T* x, const T* weight, const T* bias,
                  T leak, T* y, int threads);

/// Null for what is not wanted. Weights that feed nothing get zeros.
template <typename T>
struct NodeGradients {
    T *x, *weight, *bias;
};

/// `y` is what forward gave.
template <typename T>
void node_backward(const NodeShape& shape, const NodeSums& sums, const T* x, const T* weight, T leak,
                   const T* y, const T* grad, std::int64_t weights, const NodeGradients<T>& to, int threads);

/// Motions (samples, channels, frames, nodes) as (samples, nodes, padding + frames + padding, 2 * channels): the numbers,
/// then their differences from the frame before, those of the first frame 0.
struct MotionInputShape {
    std::int64_t samples, channels, frames, nodes, padding;
};

template <typename T>
void motion_input(const MotionInputShape& shape, const T* motion, T* to, int threads);

template <typename T>
void motion_input_backward(const MotionInputShape& shape, const T* grad, T* to, int threads);

}  // namespace actformer::model::cpu
