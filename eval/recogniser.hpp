// The recogniser at work: motions in, features and logits out, on an OpenCL device. One interface over every kind of network.
//
// To add a kind of recogniser:
//   1. Make a folder eval/NAME/ with a class that derives from Recogniser: describe it by a RecogniserInfo, and run a batch in
//      recognise(const cl::Buffer&, ...).
//   2. In that folder, read its weights file. Throw Error with the file, the place in it and the remedy.
//   3. Add a line to `kinds` in eval/recogniser.cpp: the file's attribute `kind`, and the function that opens such a file.
//   4. Let training (model/recognisers/) write weights with that attribute.
//   5. Compare it with a plain forward pass in double, as tests/eval/stgcn/recogniser_test.cpp does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ingest/dataset/representation.hpp"
#include "kernels/device.hpp"

namespace actformer::eval {

/// What a recogniser takes and gives.
struct RecogniserInfo {
    std::string kind;    ///< of network, as in "stgcn"
    std::string source;  ///< the weights file, for messages
    ingest::Representation representation;
    std::uint32_t channels = 0;  ///< numbers a node, those of all persons together
    std::uint32_t classes = 0;
    std::uint32_t features = 0;
    std::vector<int> parents;              ///< (K) of the graph; -1 for the root
    std::vector<std::string> class_names;  ///< (classes), or empty where the weights do not tell

    std::uint32_t joints() const { return static_cast<std::uint32_t>(parents.size()); }
};

struct Recognised {
    std::vector<float> features;  ///< (sequences, features)
    std::vector<float> logits;    ///< (sequences, classes)
};

/// Calls may come from one thread at a time.
class Recogniser {
  public:
    virtual ~Recogniser() = default;
    Recogniser(const Recogniser&) = delete;
    Recogniser& operator=(const Recogniser&) = delete;

    const RecogniserInfo& info() const { return info_; }

    /// motions (sequences, channels, frames, K) as they are: normalisation is the network's. Any number of sequences of any
    /// number of frames, at least 1; where memory runs out fewer sequences go to the device at once. The same motion gives the
    /// same numbers whatever else is in the batch. Throws Error for a span of another size, and OutOfMemory where not even one
    /// sequence fits.
    Recognised recognise(std::span<const float> motions, std::uint32_t sequences, std::uint32_t frames);

    /// The sequences that follow are those of the set called `name`, from its first one on. What a recogniser adds at random is a
    /// function of its seed, this name and a sequence's place in the set.
    virtual void begin_set(const std::string& /*name*/) {}

    /// The same with motions that lie on the device.
    virtual Recognised recognise(const cl::Buffer& motions, std::uint32_t sequences,
                                 std::uint32_t frames) = 0;

  protected:
    /// `device` must outlive the recogniser.
    Recogniser(kernels::Device& device, RecogniserInfo info) : device_(&device), info_(std::move(info)) {}

    kernels::Device& device() const { return *device_; }

  private:
    kernels::Device* device_;
    RecogniserInfo info_;
};

/// Opens a weights file on `device`, which must outlive the recogniser. The attribute `kind` decides which network it is; a
/// file without one is an ST-GCN. `batch`: the most sequences that anyone will ask of it at once. `initial_noise`: the seed of the
/// states that a GRU begins with, as Action2Motion's classifier has them; others have none. Throws Error, one line naming the file, for
/// another kind, for noise that it has no use for, and as the network's reader says.
std::unique_ptr<Recogniser> open_recogniser(kernels::Device& device, const std::filesystem::path& weights,
                                            std::uint32_t batch = 64,
                                            std::optional<std::uint64_t> initial_noise = {});

}  // namespace actformer::eval
