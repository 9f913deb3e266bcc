// Python's pickles (protocols 0 to 5) and joblib's files (0.10 and later, whole files compressed too), read without running them.
//
// Opcodes are interpreted by a machine that knows a closed table of names (globals.cpp): NumPy's arrays and scalars, plain containers,
// and the classes of scipy and chumpy that SMPL's model files hold, which come out as objects with their attributes. A file that names
// anything else is refused with the name and its byte.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "base/pickle/value.hpp"

namespace actformer {

struct PickleStore;

/// What a file made to exhaust a reader runs into.
struct PickleLimits {
    std::size_t nesting = 500;  ///< of values in values
    std::uint64_t memory = std::uint64_t{512}
                           << 20;  ///< bytes of values, memo and stack; arrays take next to none
    std::uint64_t unpacked = std::uint64_t{512} << 20;  ///< bytes of a compressed file's text
    bool tensors = false;  ///< PyTorch's names too, and values that lie elsewhere in its files
};

class Pickle {
  public:
    /// Called with how far the text has been read, every few megabytes.
    using Passed = std::function<void(const char* here)>;

    /// `text` must outlive this: arrays are views of it. A compressed one is unpacked into memory first. Throws Error, saying at which
    /// byte what is wrong but not in which file.
    explicit Pickle(std::string_view text, const PickleLimits& limits = {}, const Passed& passed = {});
    ~Pickle();
    Pickle(Pickle&&) noexcept;
    Pickle& operator=(Pickle&&) noexcept;

    const PickleValue& root() const { return root_; }

    /// The values that lie elsewhere, as PickleValue::reference() knows them, in the file's order; also those that root() does not
    /// lead to.
    std::vector<PickleValue> references() const;

    /// Bytes of the (unpacked) text that it takes; others may follow.
    std::uint64_t size() const { return size_; }

  private:
    void run(std::string_view text, const PickleLimits& limits, const Passed& passed);

    std::unique_ptr<PickleStore> store_;
    PickleValue root_;
    std::uint64_t size_ = 0;
};

}  // namespace actformer
