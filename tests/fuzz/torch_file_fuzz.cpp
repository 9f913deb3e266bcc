// libFuzzer: any bytes as a file of torch.save. What is taken must hold together, what is refused is one line.
#include "base/pytorch/torch_file.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Input input(data, size);
    try_to([&] {
        const TorchFile file(input.text());
        std::size_t left = 1 << 20;  // numbers that are looked at
        for (const auto& tensor : file.tensors()) {
            std::size_t count = 1;
            for (const auto length : tensor.shape) count *= length;
            if (count > left) break;
            left -= count;
            demand(tensor.values().size() == count);
        }
    });
    return 0;
}
