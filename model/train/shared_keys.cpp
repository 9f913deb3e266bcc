#include "model/train/shared_keys.hpp"

#include "base/error.hpp"

namespace actformer::model {

void check_subject_counts(const SubjectCounts& wanted, const SubjectCounts& motions,
                          const std::string& where) {
    if (wanted.persons != 0 && wanted.persons != motions.persons)
        throw Error("{}: {} person{} a clip, but the configuration says persons: {}", where, motions.persons,
                    motions.persons == 1 ? "" : "s", wanted.persons);
    if (wanted.classes != 0 && wanted.classes != motions.classes)
        throw Error("{}: {} classes, but the configuration says classes: {}", where, motions.classes,
                    wanted.classes);
}

}  // namespace actformer::model
