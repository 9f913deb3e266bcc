#include "ingest/formats/ntu/actions.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"

namespace actformer::ingest::ntu {
namespace {

constexpr std::array<std::string_view, actions> names = {
    // 1-49: daily and medical, one person
    "drink water", "eat meal", "brush teeth", "brush hair", "drop", "pick up", "throw", "sit down",
    "stand up", "clapping", "reading", "writing", "tear up paper", "put on jacket", "take off jacket",
    "put on a shoe", "take off a shoe", "put on glasses", "take off glasses", "put on a hat",
    "take off a hat", "cheer up", "hand waving", "kicking something", "reach into pocket", "hopping",
    "jump up", "phone call", "play with phone", "type on a keyboard", "point to something", "taking a selfie",
    "check time from watch", "rub two hands", "nod head or bow", "shake head", "wipe face", "salute",
    "put palms together", "cross hands in front", "sneeze or cough", "staggering", "falling down", "headache",
    "chest pain", "back pain", "neck pain", "nausea or vomiting", "fan self",
    // 50-60: two persons
    "punch or slap", "kicking", "pushing", "pat on back", "point finger", "hugging", "giving object",
    "touch pocket", "shaking hands", "walking towards", "walking apart",
    // 61-105: one person
    "put on headphone", "take off headphone", "shoot at basket", "bounce ball", "tennis bat swing",
    "juggle table tennis ball", "hush", "flick hair", "thumb up", "thumb down", "make OK sign",
    "make victory sign", "staple book", "counting money", "cutting nails", "cutting paper", "snap fingers",
    "open bottle", "sniff or smell", "squat down", "toss a coin", "fold paper", "ball up paper",
    "play magic cube", "apply cream on face", "apply cream on hand", "put on bag", "take off bag",
    "put object into bag", "take object out of bag", "open a box", "move heavy objects", "shake fist",
    "throw up cap", "capitulate", "cross arms", "arm circles", "arm swings", "run on the spot", "butt kicks",
    "cross toe touch", "side kick", "yawn", "stretch oneself", "blow nose",
    // 106-120: two persons
    "hit with object", "wield knife", "knock over", "grab stuff", "shoot with gun", "step on foot",
    "high five", "cheers and drink", "carry object", "take a photo", "follow", "whisper", "exchange things",
    "support somebody", "rock paper scissors"};

constexpr std::array<int, 53> train_performers = {1,  2,  4,  5,  8,  9,  13, 14, 15, 16,  17, 18, 19, 25,
                                                  27, 28, 31, 34, 35, 38, 45, 46, 47, 49,  50, 52, 53, 54,
                                                  55, 56, 57, 58, 59, 70, 74, 78, 80, 81,  82, 83, 84, 85,
                                                  86, 89, 91, 92, 93, 94, 95, 97, 98, 100, 103};

}  // namespace

std::string_view action_name(int action) {
    if (action < 1 || action > actions)
        throw Error("action {}: NTU RGB+D numbers its actions from 1 to {}", action, actions);
    return names[static_cast<std::size_t>(action - 1)];
}

bool two_persons(int action) {
    return (action >= 50 && action <= 60) || (action >= 106 && action <= 120);
}

std::vector<std::string> class_names(int persons) {
    std::vector<std::string> out;
    for (int action = 1; action <= actions; ++action)
        if (two_persons(action) == (persons == 2)) out.emplace_back(action_name(action));
    return out;
}

std::uint32_t label_of(int action) {
    std::uint32_t label = 0;
    for (int before = 1; before < action; ++before) label += two_persons(before) == two_persons(action);
    return label;
}

bool xsub_train(int performer) {
    return std::binary_search(train_performers.begin(), train_performers.end(), performer);
}

}  // namespace actformer::ingest::ntu
