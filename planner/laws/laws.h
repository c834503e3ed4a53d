#pragma once
#include "planner/laws/feed_plan.h"
#include "planner/laws/motion_source.h"

/// The result of planning: a FeedPlan (its MotionLaw s(t) as pieces, and what limited the feed on each
/// segment), and the one interface that plays it, MotionSource. LawSource plays a law as it is;
/// override/ plays it under the operator's override.
