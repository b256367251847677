// Copies licences and weights into python/boresight, before maturin makes a wheel or a source distribution of it.
import { preparePackage } from './lib/python/python-package.mjs';

preparePackage();
