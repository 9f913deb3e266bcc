// All scores of generated samples against one real side, whose statistics are made once.
#pragma once

#include "eval/metrics/confusion.hpp"
#include "eval/metrics/fid.hpp"
#include "eval/metrics/motion_measures.hpp"

namespace actformer::eval {

/// One side, as the recogniser sees it.
struct Observed {
    Samples samples;
    std::optional<Samples>
        groups;  ///< several persons: what the one-person recogniser sees, as largest_of_group says
    bool of_groups =
        false;  ///< `samples` are those of groups: there is no recogniser that sees the persons together
    std::optional<MotionMeasures> motion;  ///< (n) of the same motions, where they are known
    std::vector<std::string> clips;  ///< (n) the clip each sample was cut from, or empty: each from its own
    std::string source;              ///< for messages
};

/// Throws Error unless the sides have as many classes and dimensions, those of groups too where both have groups, and as many measures as samples.
void check_comparable(const Observed& real, const Observed& generated);

/// How a paper's tables are measured.
enum class Protocol {
    actformer,  ///< accuracy is the mean over classes; multimodality's pairs are of different samples; Student's interval
    actor  ///< accuracy is the share of all samples; multimodality's pairs are drawn with replacement, a mean over all
    ///< of them; 1.96 s / sqrt(n) (ACTOR's paper and code; Guo et al., Action2Motion, 2020)
};

struct ScorerOptions {
    Protocol protocol = Protocol::actformer;
    bool kid = false, fid_infinity = false;  ///< whether they are measured
    std::size_t diversity_pairs = 200, multimodality_pairs = 20;
    std::uint64_t seed = 0;  ///< of the pairs, and of the real side's halves
    unsigned threads = 0;    ///< 0: one a core
};

/// Of one set of generated samples.
struct Score {
    std::vector<std::size_t> counts;      ///< (classes) generated samples
    std::optional<Confusion> confusion;   ///< where there are logits
    std::optional<Distances> fid;         ///< where a recogniser sees the persons together
    std::optional<Distances> fid_groups;  ///< FIDa
    std::optional<double> accuracy;       ///< where there are logits, as the protocol has it
    std::optional<double> diversity, multimodality;
    std::optional<double> kid_mean, kid_whole, fid_mean_infinity, fid_whole_infinity;  ///< where asked for
    MotionScore motion;                        ///< where motions are measured
    std::vector<MotionScore> motion_by_class;  ///< (classes), or empty
    std::vector<std::size_t> identical;        ///< classes whose samples, two or more, are all the same
};

/// As the protocol has them; no multimodality where there are too few samples.
double accuracy_of(const Confusion& confusion, const ScorerOptions& options);
std::optional<double> multimodality_of(const Samples& samples, const ScorerOptions& options);

class Scorer {
  public:
    Scorer(const Observed& real, const ScorerOptions& options);

    Score score(const Observed& generated) const;

    const Statistics& real() const { return real_; }

  private:
    ScorerOptions options_;
    Statistics real_;
    std::optional<Statistics> real_groups_;
    std::optional<MotionMeasures> real_motion_;
    std::vector<std::vector<std::size_t>> real_members_;  ///< by class, where motions are measured
    std::optional<Samples> real_samples_;  ///< where a metric needs them beside their statistics
};

/// The real side against itself: what a perfect generator would come to with as many samples, for FIDs of finite sets are
/// above 0.
struct Floor {
    Score score;                    ///< of the part taken for generated
    std::vector<std::size_t> rest;  ///< (classes) real samples that it is compared with
};

/// Draws from every class clips, each with all its samples, until there are wanted[class] samples or half of the class's, and
/// scores them against the rest. A clip is never on both sides. None where a side has fewer than two samples in all.
std::optional<Floor> score_floor(const Observed& real, const std::vector<std::size_t>& wanted,
                                 const ScorerOptions& options);

}  // namespace actformer::eval
