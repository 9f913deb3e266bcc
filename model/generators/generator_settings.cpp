#include "model/generators/generator_settings.hpp"

#include "model/train/shared_keys.hpp"

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
    const auto wanted = [&](const char* key) {
        return static_cast<std::uint32_t>(config.get<std::int64_t>(key));
    };
    check_subject_counts({wanted("persons"), wanted("classes")},
                         {persons, static_cast<std::uint32_t>(classes)}, where);
}

GeneratorTrainerSettings generator_trainer_settings(const Config& config) {
    return table().read(config);
}

}  // namespace actformer::model
