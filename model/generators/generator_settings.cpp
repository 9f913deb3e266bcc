#include "model/generators/generator_settings.hpp"

namespace actformer::model {
namespace {

const KeyTable<GeneratorTrainerSettings>& table() {
    static const auto all = [] {
        using Settings = GeneratorTrainerSettings;
        KeyTable<Settings> keys;
        add_trainer_keys(keys);
        keys.add(&Settings::recogniser,
                 {.name = "recogniser",
                  .meaning = "weights (.h5) or training of a recogniser to score with; empty: none",
                  .free = true})
            .add(&Settings::score_every, {.name = "score_every",
                                          .meaning = "epochs between scores",
                                          .least = 1,
                                          .most = 1e9,
                                          .free = true})
            .add(&Settings::score_per_class, {.name = "score_per_class",
                                              .meaning = "motions of every class to score",
                                              .least = 2,
                                              .most = 100000,
                                              .free = true});
        return keys;
    }();
    return all;
}

}  // namespace

std::vector<Key> generator_keys() {
    return table().keys();
}

GeneratorTrainerSettings generator_trainer_settings(const Config& config) {
    return table().read(config);
}

}  // namespace actformer::model
