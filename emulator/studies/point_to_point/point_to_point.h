#pragma once
#include "emulator/studies/point_to_point/point_page.h"
#include "emulator/studies/point_to_point/point_report.h"
#include "emulator/studies/point_to_point/point_study.h"
#include "emulator/studies/point_to_point/table2.h"

/// `kadr law`: laws from rest to rest that leave no vibration, compared (paper 001; docs/motion_laws.md).
