#include "model/generators/generate.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include "base/error.hpp"
#include "ingest/dataset/classes.hpp"
#include "ingest/dataset/layout.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "model/generators/generator_file.hpp"
#include "model/nn/blas.hpp"
#include "model/nn/one_line.hpp"
#include "model/train/torch_device.hpp"

namespace actformer::model {
namespace {

/// Labels, from 0.
std::vector<std::uint32_t> labels_wanted(const GenerateRequest& request, const GeneratorFile& file) {
    const auto& names = file.subjects.classes;
    std::vector<std::uint32_t> labels(names.size());
    std::iota(labels.begin(), labels.end(), 0U);
    if (request.classes.empty()) return labels;
    labels.clear();
    for (const auto& said : request.classes) {
        const auto label = ingest::label_called(said, names, request.generator.string());
        if (std::ranges::count(labels, label) > 0) throw Error("--classes: {} is given twice", said);
        labels.push_back(label);
    }
    return labels;
}

std::uint32_t frames_wanted(const GenerateRequest& request, const GeneratorFile& file, std::uint32_t most) {
    if (request.frames > most)
        throw Error("{}: --frames {}, but it was made for at most {}; train one with frames={}",
                    request.generator.string(), request.frames, most, request.frames);
    return request.frames == 0 ? file.frames() : request.frames;
}

/// Of what a network gives for one motion, (P*D, T, K).
ingest::Motion motion_of(std::span<const float> values, const GenerateSummary& shape) {
    ingest::Motion motion;
    motion.frames = shape.frames;
    motion.persons = shape.persons;
    motion.nodes = shape.nodes;
    motion.numbers = shape.numbers;
    ingest::take_channels_first(values, motion);
    return motion;
}

void describe(ingest::MotionsWriter& writer, const GenerateRequest& request, const GeneratorFile& file) {
    writer.describe(file.subjects);
    writer.note("program", "actformer " ACTFORMER_VERSION);
    writer.note("generator", file.checksum);
    writer.note("configuration", file.configuration.yaml());
    writer.note("seed", std::to_string(request.seed));
}

GenerateSummary generate_here(const GenerateRequest& request,
                              const std::function<void(std::uint64_t, std::uint64_t)>& tell) {
    const auto file = load_generator(request.generator);
    const auto labels = labels_wanted(request, file);
    torch_device(request.device, "--device ");
    const auto maker = file.maker(request.device);
    const auto spec = spec_of(file.subjects, request.generator.string());
    GenerateSummary summary{0,
                            static_cast<std::uint32_t>(labels.size()),
                            spec.persons,
                            spec.numbers(),
                            spec.nodes(),
                            frames_wanted(request, file, maker->most_frames())};
    ingest::MotionsWriter writer(request.out);
    describe(writer, request, file);
    const auto all = std::uint64_t{request.per_class} * labels.size();
    const auto batch = maker->batch();
    for (const auto label : labels)
        for (std::uint32_t first = 0; first < request.per_class; first += batch) {
            const auto motions = maker->make(request.seed, label, first / batch, summary.frames);
            const auto count = std::min(batch, request.per_class - first);
            const auto one = motions.size() / batch;
            for (std::uint32_t i = 0; i < count; ++i, ++summary.motions)
                writer.add(fmt::format("A{:03}_{}", label + 1, first + i),
                           motion_of(std::span(motions).subspan(i * one, one), summary));
            if (tell) tell(summary.motions, all);
        }
    writer.finish();
    return summary;
}

}  // namespace

GenerateSummary generate(const GenerateRequest& request,
                         const std::function<void(std::uint64_t, std::uint64_t)>& tell) {
    set_threads(request.threads);
    try {
        return generate_here(request, tell);
    } catch (const c10::Error& e) {
        throw Error("libtorch: {}", one_line(e));
    }
}

}  // namespace actformer::model
