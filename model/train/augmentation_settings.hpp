// What a configuration says of augmentation. Knows nothing of torch.
#pragma once

#include "model/train/key_table.hpp"

namespace actformer::model {

/// Shares of the windows, 0 to 1.
struct AugmentationSettings {
    double mirror = 0;  ///< left and right exchanged
    double turn = 0;    ///< turned about the vertical, the y axis, by any angle
};

template <typename Settings>
void add_augmentation_keys(KeyTable<Settings>& table) {
    table
        .add(&Settings::mirror,
             {.name = "mirror",
              .meaning = "share of windows whose left and right are exchanged; of a generator's below 0.5",
              .least = 0,
              .most = 1})
        .add(&Settings::turn,
             {.name = "turn",
              .meaning = "share of windows turned about the vertical; of a generator's below 1",
              .least = 0,
              .most = 1});
}

}  // namespace actformer::model
