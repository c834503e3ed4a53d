#pragma once
#include "planner/laws/feed_plan.h"
#include "planner/laws/motion_source.h"

/// What planning hands to the cycle: a FeedPlan (its MotionLaw s(t) as pieces, and what held the feed on each
/// segment) and the one door behind which it is played, MotionSource. LawSource plays a law as it is;
/// override/ plays it under an operator's percent.
