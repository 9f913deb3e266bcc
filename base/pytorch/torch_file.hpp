// The tensors of a file that PyTorch's torch.save wrote, as a zip archive or in the older form, read without running anything.
//
// Either form is a pickle that names tensors by storages: numbers end to end that lie elsewhere in the file, and that tensors may share.
// The pickle goes through the closed table of base/pickle: what it names beyond tensors, plain values and NumPy's arrays is refused.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace actformer {

struct TorchTensor {
    enum class Type { float32, float64, float16, int64 };

    std::string
        group;  ///< keys of the dicts around it, as in "model" or "a/b"; empty where it stands in the outermost one
    std::string name;  ///< its key
    Type type = Type::float32;
    std::vector<std::uint64_t> shape, strides;  ///< strides in numbers
    std::string_view numbers;                   ///< from its first number on, to the end of its storage

    /// Row-major; rounded where float32 does not hold them.
    std::vector<float> values() const;
};

/// A file's tensors in its order. They are views of the file's bytes, or of memory that lives as long as this.
class TorchFile {
  public:
    /// Throws Error, saying where in the file but not in which file, for what is damaged, cut short, reaches beyond its storage or
    /// is no file of PyTorch's, for a pickle that names anything else, and for names of more than 1000 bytes and tensors of many
    /// times the file's numbers, which storages that they share make possible.
    explicit TorchFile(std::string_view bytes);

    const std::vector<TorchTensor>& tensors() const { return tensors_; }

  private:
    std::deque<std::vector<char>> unpacked_;
    std::vector<TorchTensor> tensors_;
};

}  // namespace actformer
