#include "model/generators/actformer/generate.hpp"

#include <algorithm>
#include <numeric>

#include "base/error.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "model/cpu/blas.hpp"
#include "model/generators/actformer/generator_file.hpp"
#include "model/generators/actformer/motion_maker.hpp"
#include "model/train/training.hpp"

namespace actformer::model {
namespace {

/// Labels, from 0.
std::vector<std::uint32_t> labels_wanted(const GenerateRequest& request, const GeneratorFile& file) {
    const auto& names = file.subjects.classes;
    std::vector<std::uint32_t> labels(names.size());
    std::iota(labels.begin(), labels.end(), 0U);
    if (request.classes.empty()) return labels;
    labels.clear();
    for (const auto wanted : request.classes) {
        if (wanted < 1 || wanted > names.size())
            throw Error("{}: there is no class {}; its classes are 1 ('{}') to {} ('{}')",
                        request.generator.string(), wanted, names.front(), names.size(), names.back());
        if (std::ranges::count(labels, wanted - 1) > 0) throw Error("--classes: {} is given twice", wanted);
        labels.push_back(wanted - 1);
    }
    return labels;
}

std::uint32_t frames_wanted(const GenerateRequest& request, const GeneratorFile& file) {
    const auto most = file.network->settings().frames;
    if (request.frames > most)
        throw Error("{}: --frames {}, but it was made for at most {}; train one with frames={}",
                    request.generator.string(), request.frames, most, request.frames);
    return request.frames == 0 ? most : request.frames;
}

/// One of `made` (n, P*D, T, K) with persons side by side, as a motion.
ingest::Motion motion_of(const at::Tensor& made, std::int64_t sample, std::uint32_t persons) {
    const auto one = made[sample];
    ingest::Motion motion;
    motion.persons = persons;
    motion.frames = static_cast<std::uint32_t>(one.size(1));
    motion.nodes = static_cast<std::uint32_t>(one.size(2));
    motion.numbers = static_cast<std::uint32_t>(one.size(0)) / persons;
    const auto values =
        one.view({persons, -1, one.size(1), one.size(2)}).permute({2, 0, 3, 1}).contiguous();  // (T, P, K, D)
    const auto* first = values.data_ptr<float>();
    motion.values.assign(first, first + values.numel());
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
    GenerateSummary summary{0, static_cast<std::uint32_t>(labels.size()), file.subjects.persons,
                            static_cast<std::uint32_t>(file.subjects.topology.joints()),
                            frames_wanted(request, file)};
    file.network->to(torch_device(request.device));
    const MotionMaker maker(*file.network, request.seed, summary.frames);
    ingest::MotionsWriter writer(request.out);
    describe(writer, request, file);
    const auto all = std::uint64_t{request.per_class} * labels.size();
    for (const auto label : labels)
        for (std::uint32_t first = 0; first < request.per_class; first += MotionMaker::chunk) {
            const auto made = maker.make(label, first / MotionMaker::chunk);
            const auto count = std::min(MotionMaker::chunk, request.per_class - first);
            for (std::uint32_t i = 0; i < count; ++i, ++summary.motions)
                writer.add(fmt::format("A{:03}_{}", label + 1, first + i),
                           motion_of(made, i, file.subjects.persons));
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
