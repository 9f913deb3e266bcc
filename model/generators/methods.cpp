#include <algorithm>

#include "base/error.hpp"
#include "base/text/nearest_word.hpp"
#include "base/text/printable.hpp"
#include "eval/recogniser_kind.hpp"
#include "model/generators/actformer/method.hpp"
#include "model/generators/action2motion/method.hpp"
#include "model/generators/actor/method.hpp"
#include "model/generators/csgn/method.hpp"
#include "model/generators/generator_settings.hpp"
#include "model/generators/method.hpp"
#include "model/train/learner.hpp"

namespace actformer::model {

const std::vector<Method>& methods() {
    static const std::vector<Method> all{
        actformer_method(),
        action2motion::method(),
        actor_method(),
        csgn_method(),
    };
    return all;
}

namespace {

/// What a file's line `model:` may say in place of a method's name: "generator" was ActFormer's before there were others.
std::vector<std::string> other_names(const Method& method) {
    if (method.name != methods().front().name) return {};
    return {"", "generator"};
}

}  // namespace

const Method& method_named(const std::string& name, const std::string& where) {
    std::vector<std::string> names;
    for (const auto& method : methods()) {
        const auto others = other_names(method);
        if (method.name == name || std::ranges::count(others, name) > 0) return method;
        names.push_back(method.name);
    }
    const auto nearest = nearest_word(name, names);
    throw Error("{}: there is no method {}; {}", where, in_quotes(name),
                nearest.empty() ? fmt::format("the methods are {}", fmt::join(names, ", "))
                                : fmt::format("did you mean '{}'?", nearest));
}

Config generator_config(const Method& method) {
    auto keys = method.keys();
    for (auto& key : generator_keys()) keys.push_back(std::move(key));
    return Config(method.name, std::move(keys), other_names(method));
}

Config read_generator_config(const std::filesystem::path& file) {
    const auto named = model_named_in(file);
    if (eval::recogniser_kind_named(named))
        throw Error(
            "{}: a recogniser's configuration, as `model: {}` says; `actformer train recogniser` takes it",
            file.string(), named);
    auto config = generator_config(method_named(named, file.string()));
    config.load(file);
    return config;
}

MotionSpec spec_of(const ingest::Subjects& subjects, const std::string& where) {
    MotionSpec spec;
    spec.representation = subjects.representation;
    spec.topology = subjects.topology;
    spec.persons = subjects.persons;
    spec.classes = static_cast<std::uint32_t>(subjects.classes.size());
    spec.where = where;
    spec.bone_length = subjects.bone_length;
    spec.rest = subjects.rest;
    return spec;
}

void check_frame(std::int64_t numbers, const MotionSpec& spec) {
    const auto wanted = std::int64_t{spec.nodes()} * spec.numbers() * spec.persons;
    if (numbers != wanted)
        throw Error(
            "{}: weights for {} numbers a frame, and the dataset's frames have {}: {} nodes of {} numbers "
            "({}) of {} "
            "person{}",
            spec.where, numbers, wanted, spec.nodes(), spec.numbers(), spec.representation.name(),
            spec.persons, spec.persons == 1 ? "" : "s");
}

}  // namespace actformer::model
