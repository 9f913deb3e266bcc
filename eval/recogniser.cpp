#include "eval/recogniser.hpp"

#include <array>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/gru/recogniser.hpp"
#include "eval/stgcn/recogniser.hpp"
#include "ingest/dataset/own_kind.hpp"
#include "kernels/buffer.hpp"

namespace actformer::eval {
namespace {

using Noise = std::optional<std::uint64_t>;
using Open = std::unique_ptr<Recogniser> (*)(kernels::Device&, const std::filesystem::path&, std::uint32_t,
                                             Noise);

struct Kind {
    const char* name;
    Open open;
};

std::unique_ptr<Recogniser> open_stgcn_without_noise(kernels::Device& device,
                                                     const std::filesystem::path& weights,
                                                     std::uint32_t batch, Noise initial_noise) {
    if (initial_noise)
        throw Error("{}: an ST-GCN has no initial state; leave --initial-noise out", weights.string());
    return open_stgcn(device, weights, batch);
}

constexpr std::array kinds{Kind{"stgcn", open_stgcn_without_noise}, Kind{"gru", open_gru}};

std::string text_of(const hdf5::Reader& file, const std::string& attribute) {
    const auto texts = file.attribute_texts(attribute);
    return texts.empty() ? "" : texts[0];
}

std::string kind_of(const std::filesystem::path& weights) {
    const hdf5::Reader file(weights);
    if (!file.has_attribute("channels"))
        ingest::refuse_other_file(file, weights.string(), ingest::own::recogniser,
                                  "give a recogniser's training or its weights");
    return file.has_attribute("kind") ? text_of(file, "kind") : kinds[0].name;
}

}  // namespace

Recognised Recogniser::recognise(std::span<const float> motions, std::uint32_t sequences,
                                 std::uint32_t frames) {
    const std::size_t expected = std::size_t{sequences} * info_.channels * frames * info_.joints();
    if (motions.size() != expected)
        throw Error("{} numbers for {} motions of {} frames, where {} are expected", motions.size(),
                    sequences, frames, expected);
    try {
        return recognise(kernels::Buffer<float>(*device_, motions).memory(), sequences, frames);
    } catch (const OutOfMemory&) {
        if (sequences < 2) throw;
    }
    const auto half = sequences / 2;
    const auto middle = expected / sequences * half;
    auto out = recognise(motions.first(middle), half, frames);
    const auto rest = recognise(motions.subspan(middle), sequences - half, frames);
    out.features.insert(out.features.end(), rest.features.begin(), rest.features.end());
    out.logits.insert(out.logits.end(), rest.logits.begin(), rest.logits.end());
    return out;
}

std::unique_ptr<Recogniser> open_recogniser(kernels::Device& device, const std::filesystem::path& weights,
                                            std::uint32_t batch, Noise initial_noise) {
    const auto name = kind_of(weights);
    std::string known;
    for (const auto& kind : kinds) {
        if (name == kind.name) return kind.open(device, weights, batch, initial_noise);
        known += (known.empty() ? "" : ", ") + std::string(kind.name);
    }
    throw Error("{}: attribute 'kind' is '{}', and the recognisers known are: {}", weights.string(), name,
                known);
}

}  // namespace actformer::eval
