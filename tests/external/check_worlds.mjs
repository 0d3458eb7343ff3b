// Khronos' validator on worlds as .glb: no errors.
import fs from "node:fs";
import validator from "gltf-validator";

let failed = false;
for (const path of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path)), { uri: path, maxIssues: 0 });
  const { numErrors, numWarnings, messages } = report.issues;
  console.log(`${path}: ${report.info.totalTriangleCount} triangles, ${numErrors} errors, ${numWarnings} warnings`);
  for (const issue of messages.filter((m) => m.severity === 0).slice(0, 10))
    console.log(`  ${issue.code} at ${issue.pointer ?? issue.offset}: ${issue.message}`);
  failed ||= numErrors > 0;
}
process.exit(failed ? 1 : 0);
