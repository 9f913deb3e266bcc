#include "ingest/synth/babel/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "ingest/synth/babel/acts.hpp"
#include "ingest/synth/random.hpp"

namespace actformer::ingest::synth {
namespace {

/// Subsets of AMASS by the folder names in BABEL's feat_p, and the share of recordings they have here.
struct Subset {
    const char *folder, *set;
    double fps, share;
};
constexpr std::array<Subset, 6> subsets{{{"CMU", "CMU", 60, 0.34},
                                         {"CMU", "CMU", 120, 0.16},
                                         {"KIT", "KIT", 100, 0.2},
                                         {"BMLrub", "BioMotionLab_NTroje", 120, 0.1},
                                         {"SSMsynced", "SSM_synced", 59.9999885559082, 0.16},
                                         {"EyesJapanDataset", "Eyes_Japan_Dataset", 250, 0.04}}};

const Subset& drawn(Random& random) {
    double u = random.uniform();
    for (const auto& subset : subsets)
        if ((u -= subset.share) < 0) return subset;
    return subsets[0];
}

/// Cut into recordings, in an order drawn at random.
void add_sequences(std::vector<std::size_t> chosen, bool validation, Random& random,
                   std::vector<PlannedSequence>& out) {
    for (std::size_t i = chosen.size(); i > 1; --i)
        std::swap(chosen[i - 1], chosen[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
    for (std::size_t at = 0; at < chosen.size();) {
        const auto count = std::min(chosen.size() - at, static_cast<std::size_t>(2 + random.below(4)));
        const auto& subset = drawn(random);
        const auto subject = 1 + random.below(30);
        PlannedSequence one{subset.folder,
                            subset.set,
                            fmt::format("{:02}", subject),
                            fmt::format("{:02}_{:04}", subject, out.size() + 1),
                            validation,
                            subset.fps,
                            {chosen.begin() + static_cast<std::ptrdiff_t>(at),
                             chosen.begin() + static_cast<std::ptrdiff_t>(at + count)}};
        out.push_back(std::move(one));
        at += count;
    }
}

}  // namespace

std::string PlannedSequence::feat_p() const {
    return fmt::format("{}/{}/{}/{}_poses.npz", folder, set, subject, trial);
}

std::vector<std::uint64_t> occurrences(std::uint64_t actions, std::size_t categories) {
    const std::uint64_t all = std::min<std::uint64_t>(8, actions / categories);
    std::vector<std::uint64_t> out(categories, all);
    double weights = 0;
    for (std::size_t c = 0; c < categories; ++c) weights += 1.0 / static_cast<double>(c + 4);
    const std::uint64_t more = actions - all * categories;
    std::uint64_t given = 0;
    for (std::size_t c = 0; c < categories; ++c) {
        const auto part =
            static_cast<std::uint64_t>(static_cast<double>(more) / static_cast<double>(c + 4) / weights);
        out[c] += part;
        given += part;
    }
    for (std::size_t c = 0; given < more; ++given, c = (c + 1) % categories) ++out[c];
    return out;
}

std::vector<PlannedSequence> plan(std::uint64_t actions, std::uint64_t seed) {
    Random random{seed, 0xBABE1};
    std::vector<std::size_t> training, validation;
    const auto counts = occurrences(actions, acts().size());
    for (std::size_t c = 0; c < counts.size(); ++c) {
        const auto held_out = counts[c] > 1 ? std::max<std::uint64_t>(1, (counts[c] * 3 + 5) / 10) : 0;
        training.insert(training.end(), counts[c] - held_out, c);
        validation.insert(validation.end(), held_out, c);
    }
    std::vector<PlannedSequence> out;
    add_sequences(std::move(training), false, random, out);
    add_sequences(std::move(validation), true, random, out);
    return out;
}

}  // namespace actformer::ingest::synth
