// Accuracy, and which class was taken for which.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "eval/metrics/samples.hpp"

namespace actformer::eval {

/// Of a Confusion, which has their square in counts.
inline constexpr std::size_t most_confused_classes = 4096;

/// Throws Error, beginning with `where`, for more classes.
inline void check_class_count(std::size_t classes, const std::string& where) {
    if (classes > most_confused_classes)
        throw Error("{}: {} classes, and scores are of up to {}: leave out those without samples", where,
                    classes, most_confused_classes);
}

class Confusion {
  public:
    explicit Confusion(std::size_t classes) : classes_(classes), counts_(classes * classes, 0) {}

    void add(std::size_t truth, std::size_t guess) { ++counts_[truth * classes_ + guess]; }

    std::size_t classes() const { return classes_; }
    std::uint64_t at(std::size_t truth, std::size_t guess) const { return counts_[truth * classes_ + guess]; }
    std::uint64_t samples() const;

    /// Mean over the classes that have samples of the share recognised, 0..1; 0 without samples.
    double mean_class_accuracy() const;

    /// Share of the samples recognised, 0..1; 0 without samples.
    double sample_accuracy() const;

    /// One row a class that has samples or was guessed: its name, its samples, and its shares in per cent. More classes
    /// than a terminal shows side by side get a list: what each is recognised as, and its commonest mistakes.
    std::string table(const std::vector<std::string>& names) const;

    /// (classes, classes) counts, rows the truth.
    std::vector<std::vector<std::uint64_t>> rows() const;

  private:
    std::uint64_t row_sum(std::size_t truth) const;
    double per_cent(std::size_t truth, std::size_t guess) const;
    std::vector<std::size_t> seen() const;
    std::string square(const std::vector<std::string>& names, const std::vector<std::size_t>& shown,
                       std::size_t width) const;
    std::string list(const std::vector<std::string>& names, const std::vector<std::size_t>& shown,
                     std::size_t width) const;

    std::size_t classes_;
    std::vector<std::uint64_t> counts_;
};

/// A warning where a recogniser with this accuracy on real motions (0..1) is hardly better than guessing one of `classes`: within a
/// tenth of the way from chance to 1. Empty elsewhere.
std::string near_chance(double accuracy, std::size_t classes);

/// Label against largest logit (of equal ones the first). Its mean_class_accuracy() is the accuracy of the tables: the mean
/// over the classes that have samples of the share recognised.
Confusion confusion_of(const Samples& samples);

}  // namespace actformer::eval
