// Replaces @stdlib/assert-has-generator-support in the built page (vite.config.ts). The original uses eval, which the
// page's policy forbids and the browser reports. Every browser with WebXR has generators.
module.exports = () => true;
