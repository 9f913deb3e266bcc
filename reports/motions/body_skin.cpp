#include "reports/motions/body_skin.hpp"

#include "ingest/dataset/body_model.hpp"

namespace actformer::reports {

BodySkin::BodySkin(const std::filesystem::path& file)
    : body_(ingest::read_smpl_body(file)), skinning_(device_, body_.skin) {}

std::vector<float> BodySkin::vertices(const ingest::Motion& motion, std::size_t frame) const {
    std::vector<float> rotations, translations;
    for (std::size_t p = 0; p < motion.persons; ++p) {
        for (std::size_t j = 0; j < ingest::smpl_joints; ++j)
            for (const double r : ingest::rotation_of(motion.at(frame, p, j)))
                rotations.push_back(static_cast<float>(r));
        const float* moved = motion.at(frame, p, ingest::smpl_joints);
        translations.insert(translations.end(), moved, moved + 3);
    }
    std::vector<float> out(std::size_t{motion.persons} * body_.skin.rest.size());
    const std::scoped_lock lock(one_at_a_time_);
    skinning_.pose(rotations, translations);
    skinning_.vertices().download(out);
    return out;
}

}  // namespace actformer::reports
