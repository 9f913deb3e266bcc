// Keys that several methods and recognisers have, each said once. Knows nothing of torch.
#pragma once

#include <cstdint>
#include <string>

#include "model/train/key_table.hpp"

namespace actformer::model {

/// Whose motions: `persons`, `classes`.
template <typename Settings>
void add_subject_keys(KeyTable<Settings>& table) {
    table
        .add(&Settings::persons,
             {.name = "persons", .meaning = "persons a clip; 0 takes the dataset's", .least = 0, .most = 16})
        .add(&Settings::classes,
             {.name = "classes", .meaning = "classes; 0 takes the dataset's", .least = 0, .most = 100000});
}

struct SubjectCounts {
    std::uint32_t persons = 0, classes = 0;
};

/// Throws Error, beginning with `where`, where a configuration wants other numbers than the motions have; 0 takes any.
void check_subject_counts(const SubjectCounts& wanted, const SubjectCounts& motions,
                          const std::string& where);

/// `beta1`, `beta2`.
template <typename Settings>
void add_adam_keys(KeyTable<Settings>& table) {
    table
        .add(&Settings::beta1,
             {.name = "beta1", .meaning = "of Adam: decay of the mean gradient", .least = 0, .most = 0.9999})
        .add(&Settings::beta2, {.name = "beta2",
                                .meaning = "of Adam: decay of the mean squared gradient",
                                .least = 0,
                                .most = 0.999999});
}

/// `padding`, of kernels::Padding.
template <typename Settings>
void add_padding_key(KeyTable<Settings>& table) {
    table.add(
        &Settings::padding,
        {.name = "padding",
         .meaning = "clips shorter than a window: back-and-forth, or hold the last frame (public tools)",
         .choices = {"back-and-forth", "hold"}});
}

/// `average`.
template <typename Settings>
void add_ema_key(KeyTable<Settings>& table) {
    table.add(&Settings::average,
              {.name = "average",
               .meaning = "decay a step of the EMA of a generator's weights, as in 0.999; 0 keeps none",
               .least = 0,
               .most = 0.999999});
}

}  // namespace actformer::model
