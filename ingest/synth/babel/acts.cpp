#include "ingest/synth/babel/acts.hpp"

#include "ingest/synth/programmes/everyday.hpp"
#include "ingest/synth/programmes/ntu.hpp"

namespace actformer::ingest::synth {
namespace {

Act ntu(std::string_view category, int action, std::vector<std::string_view> also = {}) {
    return {category, &programme_of(action), std::move(also)};
}

Act day(std::string_view category, std::string_view name, std::vector<std::string_view> also = {}) {
    return {category, &everyday_programme(name), std::move(also)};
}

/// Where the programme is called as the category is.
Act so_called(std::string_view category, std::vector<std::string_view> also = {}) {
    return day(category, category, std::move(also));
}

}  // namespace

std::span<const Act> acts() {
    static const std::vector<Act> all{
        so_called("walk", {"forward movement"}),
        so_called("stand"),
        ntu("hand movements", 34),
        so_called("turn"),
        day("interact with/use object", "use object"),
        so_called("arm movements"),
        so_called("t pose"),
        so_called("step"),
        so_called("backwards movement", {"walk"}),
        day("raising body part", "raise arms", {"arm movements"}),
        so_called("look"),
        so_called("touch object"),
        so_called("leg movements"),
        so_called("forward movement"),
        so_called("circular movement", {"walk"}),
        ntu("stretch", 104),
        so_called("jump"),
        so_called("touching body part"),
        ntu("sit", 8),
        ntu("place something", 89, {"interact with/use object"}),
        ntu("take/pick something up", 6),
        so_called("run", {"forward movement"}),
        so_called("bend"),
        ntu("throw", 7),
        so_called("foot movements"),
        so_called("a pose"),
        ntu("stand up", 9),
        day("lowering body part", "lower arms"),
        so_called("sideways movement"),
        day("move up/down incline", "incline"),
        ntu("action with ball", 64),
        ntu("kick", 24),
        ntu("gesture", 69),
        so_called("head movements"),
        so_called("jog", {"forward movement"}),
        ntu("grasp object", 78),
        so_called("waist movements"),
        ntu("lift something", 92),
        so_called("knee movement", {"leg movements"}),
        ntu("wave", 23, {"gesture"}),
        so_called("move something"),
        ntu("swing body part", 98, {"arm movements"}),
        so_called("catch"),
        so_called("dance"),
        so_called("lean"),
        ntu("greet", 38),
        so_called("poses"),
        ntu("touching face", 85),
        ntu("sports move", 65),
        day("exercise/training", "exercise"),
        so_called("clean something"),
        day("punch", "boxing"),
        so_called("squat"),
        so_called("scratch"),
        ntu("hop", 26),
        ntu("play sport", 63),
        ntu("stumble", 42),
        ntu("crossing limbs", 96),
        ntu("perform", 66),
        ntu("martial art", 102, {"kick"}),
        so_called("balance"),
        so_called("kneel"),
        ntu("shake", 93),
        ntu("grab body part", 44),
        ntu("clap", 10),
        so_called("crouch"),
        so_called("spin", {"turn"}),
        so_called("upper body movements"),
        so_called("knock"),
        ntu("adjust", 18),
        so_called("crawl"),
        so_called("twist"),
        day("move back to original position", "move back"),
        ntu("bow", 35),
        so_called("hit"),
        so_called("touch ground"),
        so_called("shoulder movements"),
        ntu("telephone call", 28),
        so_called("grab person"),
        so_called("play instrument"),
        so_called("tap"),
        so_called("spread"),
        so_called("skip"),
        so_called("rolling movement"),
        so_called("jump rope", {"jump"}),
        ntu("play catch", 94),
        ntu("drink", 1),
        so_called("evade"),
        so_called("support"),
        ntu("point", 31),
        so_called("side to side movement"),
        so_called("stop"),
        so_called("protect"),
        so_called("wrist movements"),
        so_called("stances"),
        so_called("wait"),
        so_called("shuffle"),
        so_called("lunge"),
        day("communicate (vocalise)", "communicate"),
        so_called("jumping jacks", {"exercise/training"}),
        ntu("rub", 86),
        ntu("dribble", 64),
        so_called("swim"),
        so_called("sneak"),
        day("to lower a body part", "lower knee"),
        day("misc. abstract action", "abstract action"),
        day("mix", "stir"),
        so_called("limp", {"walk"}),
        so_called("sway"),
        so_called("slide"),
        so_called("cartwheel"),
        so_called("press something"),
        so_called("shrug"),
        ntu("open something", 91),
        so_called("leap", {"jump"}),
        ntu("trip", 42),
        so_called("golf"),
        day("move misc. body part", "misc body part"),
        ntu("get injured", 43),
        so_called("sudden movement"),
    };
    return all;
}

}  // namespace actformer::ingest::synth
