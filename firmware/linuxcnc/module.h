// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// What rtapi_app calls when it loads the module and before it unloads it. 0, or a negative errno. setup.
extern "C" int rtapi_app_main();
extern "C" void rtapi_app_exit();
