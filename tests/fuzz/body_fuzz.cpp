// libFuzzer: any bytes as a body model's file. What is taken must hold together, what is refused is one line.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/error.hpp"
#include "ingest/smpl/body_file.hpp"
#include "ingest/smpl/model_arrays.hpp"

using namespace actformer;
using namespace actformer::ingest;

namespace {

void demand(bool holds) {
    if (!holds) std::abort();
}

template <typename Read>
void try_to(Read read) {
    try {
        read();
    } catch (const Error& e) {
        demand(*e.what() != '\0' && std::string_view(e.what()).find('\n') == std::string_view::npos);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // In an allocation of just that size, so that the sanitizer sees any byte read beyond it.
    const auto copy = std::make_unique<char[]>(size);
    std::copy(data, data + size, copy.get());
    const std::string_view bytes(copy.get(), size);
    try_to([&] {
        const auto body = parse_smpl_body(bytes, "body");
        for (const auto v : body.faces) demand(v < body.skin.vertices());
        demand(body.rest().offsets.size() == 72 && body.skin.first.size() == body.skin.vertices() + 1);
    });
    // Few inputs get past all that a model must have: its arrays on their own.
    for (const auto read : {read_model_npz, read_model_pickle})
        try_to([&] {
            for (const auto& [name, array] : read(bytes, {"a", "b", "J_regressor", "shapedirs", "f"})) {
                std::uint64_t meant = 1;
                for (const auto n : array.shape) meant *= n;
                demand(meant == array.values.size());
            }
        });
    return 0;
}
