# SPDX-License-Identifier: GPL-3.0-or-later
# Tests that measure times of milliseconds run alone: other tests beside them would make them late. They run first (COST): later all others
# would have to end before them.
set_tests_properties(ModbusOutputLine.NoFaultOfASerialLineMakesAStep PROPERTIES RUN_SERIAL TRUE COST 5000)
