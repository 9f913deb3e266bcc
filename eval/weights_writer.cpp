#include "eval/weights_writer.hpp"

#include "base/hdf5/writer.hpp"

namespace actformer::eval {

void write_recogniser_attributes(hdf5::Writer& file, const std::string& kind,
                                 const RecogniserAttributes& about, std::optional<std::uint32_t> center) {
    file.attribute("kind", kind);
    file.attribute("representation", about.representation.name());
    if (!about.class_names.empty()) file.attribute("class_names", about.class_names);
    file.attribute("channels", std::int64_t{about.channels});
    file.attribute("classes", std::int64_t{about.classes});
    file.attribute("parents", std::vector<std::int64_t>(about.parents.begin(), about.parents.end()));
    if (center) file.attribute("center", std::int64_t{*center});
}

}  // namespace actformer::eval
