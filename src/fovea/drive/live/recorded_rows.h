// Rows of poses.csv, gnss.csv and imu.csv in memory (navigation/navigation_columns.h).
#pragma once

#include "fovea/drive/scans/csv_rows.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

CsvRows pose_rows();         ///< without a row
CsvRows position_rows();     ///< without a row
CsvRows orientation_rows();  ///< without a row
CsvRows inertia_rows();      ///< without a row

void add_row(CsvRows& rows, const RecordedPose& pose);
void add_row(CsvRows& rows, const RecordedPosition& position);
void add_orientation(CsvRows& rows, const RecordedInertia& inertia);
void add_inertia(CsvRows& rows, const RecordedInertia& inertia);

}  // namespace fovea
