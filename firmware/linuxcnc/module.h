// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// rtapi_app calls rtapi_app_main after it loads the module, and rtapi_app_exit before it unloads the module.
/// rtapi_app_main returns 0, or a negative errno. Not real-time safe.
extern "C" int rtapi_app_main();
extern "C" void rtapi_app_exit();
