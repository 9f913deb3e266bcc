#include "ingest/formats/babel/babel_command.hpp"

namespace actformer::ingest {

std::vector<Option> BabelCommand::list() {
    std::vector<Option> options{
        Option("--categories",
               "Classes: how many of BABEL's most frequent, a file with a name a line, or names with commas "
               "between",
               "120|60|N|FILE|NAMES", &babel.categories)
            .with_default(),
        Option("--fps", "Frames a second to resample to, by slerp", "F", &babel.fps).with_default(),
        Option("--published",
               "Resample as the public tools do: a cubic spline through rotation vectors from the first "
               "frame to the last; "
               "z stays up, while `turn` of a training turns about y",
               "", &babel.published)};
    for (auto& option : babel.rotational.list()) options.push_back(std::move(option));
    return options;
}

std::unique_ptr<Format> BabelCommand::open(const std::string& dataset) const {
    auto options = babel;
    options.dataset = dataset;
    return std::make_unique<BabelFormat>(std::move(options));
}

}  // namespace actformer::ingest
