// The clips that windows are drawn from, and how they are drawn.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace actformer::kernels {

/// A window is centred: the position that node `root` carries in its first three numbers is averaged over the window's
/// frames and persons, and taken from the first three numbers of `count` nodes from `first` on.
struct Centring {
    std::uint32_t root = 0, first = 0, count = 1;
};

/// What is known of the clips before their frames come.
struct ClipTable {
    std::uint32_t persons = 1, nodes = 0, numbers = 3;  ///< persons at most 16; numbers of a node
    std::vector<std::uint32_t> frames;                  ///< (clips) each at least 1
    std::vector<std::uint32_t> labels;                  ///< (clips)
    std::optional<Centring> centring = {};              ///< none: windows are shown as they are

    std::size_t clips() const { return frames.size(); }
    std::size_t frame_values() const { return std::size_t{persons} * nodes * numbers; }
};

enum class ClassSampling {
    square_root,  ///< class c with probability proportional to sqrt(its clips)
    plain         ///< to its clips: every clip as likely
};

/// What a window shows of a clip shorter than itself.
enum class Padding {
    back_and_forth,  ///< 0 1 .. n-1 n-2 .. 1 0 1 ..
    hold             ///< the last frame again and again
};

struct SamplerOptions {
    std::uint64_t seed = 0;
    ClassSampling classes = ClassSampling::square_root;
    bool permute_persons = true;
    std::uint32_t first_sample = 0;  ///< of a batch's part: how many samples of it others draw before these
    Padding padding = Padding::back_and_forth;
};

}  // namespace actformer::kernels
