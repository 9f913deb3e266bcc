#include "model/generators/generator_settings.hpp"

#include "base/error.hpp"

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

void check_subjects(const Config& config, std::uint32_t persons, std::size_t classes,
                    const std::string& where) {
    const auto wanted_persons = config.get<std::int64_t>("persons"),
               wanted_classes = config.get<std::int64_t>("classes");
    if (wanted_persons != 0 && wanted_persons != persons)
        throw Error("{}: {} person{} a clip, but the configuration says persons: {}", where, persons,
                    persons == 1 ? "" : "s", wanted_persons);
    if (wanted_classes != 0 && static_cast<std::size_t>(wanted_classes) != classes)
        throw Error("{}: {} classes, but the configuration says classes: {}", where, classes, wanted_classes);
}

GeneratorTrainerSettings generator_trainer_settings(const Config& config) {
    return table().read(config);
}

}  // namespace actformer::model
